// The run's own thread does all work here: between two steps it checks for requests. In a team of ranks, rank 0 checks,
// and broadcasts the next action in a vote. To check, it pauses the run.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/core/team.hpp>
#include <boltzmann/recording/recording.hpp>
#include <boltzmann/window/address_file.hpp>
#include <boltzmann/window/frame_pace.hpp>
#include <boltzmann/window/live_run.hpp>
#include <boltzmann/window/run_start.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <exception>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

namespace boltzmann {
namespace {

using nlohmann::json;

constexpr double usual_frames = 610;  // default number of frames of a run: about ten seconds

enum class Command { pause, play, rewind };

/// The state that clients have requested.
struct Orders {
  Command command = Command::pause;
  std::optional<std::int64_t> goal;  // the target step of STEP
  std::optional<double> step_size;
  bool quit = false;

  bool operator==(Orders const&) const = default;
  bool nothing() const { return command == Command::pause && !goal && !step_size; }
  void pause() {
    command = Command::pause;
    goal.reset();
  }
};

/// The next action of the simulation.
struct Deed {
  enum What : std::int64_t { wait, play, rewind, step_size, draw, picture, end } what;
  std::int64_t steps = 0;
  double size = 0;           // of a step
  std::string request = {};  // the requested drawing
};

/// The range of the run, and the requested number of steps.
struct Plan {
  std::int64_t first = 0, target = 0, steps = 0;
};

/// Notifications for clients besides pictures. The counts increase with each new one.
struct Told {
  std::uint64_t scene = 1, notice = 1;
  std::string message;
  json missed;  // the distance from the start after REWD

  void say(std::string text) {
    message = std::move(text);
    ++notice;
  }
};

}  // namespace

struct LiveRun::State {
  State(Views& the_views, Clients& the_clients, Recording* the_recording, LiveOptions the_options)
      : views(the_views),
        clients(the_clients),
        recording(the_recording),
        simulation(the_views.simulation()),
        options(std::move(the_options)),
        pace(the_clients, !boltzmann::team().alone()) {}

  Views& views;
  Clients& clients;
  Recording* recording;
  Simulation& simulation;
  LiveOptions options;

  Orders wanted, doing;  // doing: those that the current run() of the simulation executes
  Plan plan;
  Told told;
  FramePace pace;
  RunStart start;
  ShownTable table;
  std::exception_ptr failure;
  Attendant observer{};
  Team& team = boltzmann::team();
  bool inside = false;       // within run() or rewind() of the simulation
  bool begun = false;        // one of them has been called
  bool moving = false;       // true until the next wait
  bool resumes = false;      // a frame has been drawn, and no step done since
  bool told_of_end = false;  // clients were notified that a condition of the recording has ended the run

  // STEP runs unthrottled.
  bool hurried() const { return wanted.goal.has_value(); }
  bool wants_start(std::int64_t step) const { return !start.kept() && step == plan.first; }

  // Called after every step, often more than once.
  bool look(std::int64_t step) { return inside && pace.due(step, wants_start(step), hurried()); }

  // Shows a finished step to clients.
  void observe() {
    if (wants_start(simulation.step())) start.keep(simulation);
    ++told.scene;
    pace.count(simulation.step());
    clients.handle_requests();
    pace.draw(hurried(), [&] { return turned() || simulation.stopped(); });
    if (turned()) simulation.pause();
  }

  bool turned() const { return wanted != doing; }

  // Compares the state after REWD with the start of the run.
  void compare_with_start() {
    auto const most = start.missed(simulation);
    if (!most) return;
    bool const exact = most->position == 0 && most->velocity == 0;
    told.missed = {
        {"position", most->position},
        {"velocity", most->velocity},
        {"text", exact ? std::string("back at the start, exactly")
                       : fmt::format("back at the start, which is missed by up to {} in position and {} in velocity",
                                     views.quantity(most->position, dimensions::length),
                                     views.quantity(most->velocity, dimensions::velocity))}};
    ++told.notice;
  }

  void want(Command what) {
    if (wanted.command != what) ++told.notice;
    wanted.command = what;
  }

  // Runs the simulation until another action is requested, or the goal is reached.
  void go(Deed const& deed) {
    if (!begun && !team.alone()) {  // all ranks observe the start, as rank 0 does
      begun = true;
      simulation.run(0);
      if (team.first()) start.keep(simulation);
    }
    begun = true;
    if (!moving || doing != wanted) pace.start(simulation.step());
    doing = wanted;
    moving = true;
    {
      inside = true;
      struct Outside {
        bool& inside;
        ~Outside() { inside = false; }
      } const outside{inside};
      auto const steps = static_cast<std::uint64_t>(deed.steps);
      if (deed.what == Deed::rewind)
        simulation.rewind(steps);
      else
        simulation.run(steps);
    }
    if (!team.first()) return;
    if (wanted.goal == simulation.step()) wanted.goal.reset();
    if (recording && recording->ended_step() == simulation.step() && deed.what == Deed::play && !told_of_end) {
      told_of_end = true;
      plan.target = simulation.step();
      wanted.goal.reset();
      want(Command::pause);
      told.say("the run has ended: " + recording->ended_by());
    }
    ++told.scene;
    if (doing.goal || doing.command == Command::rewind) arrive();
    bool const at_end =
        doing.command == Command::play ? simulation.step() >= plan.target : simulation.step() <= plan.first;
    if (!doing.goal && at_end && wanted.command == doing.command) want(Command::pause);
    if (team.alone()) return;
    observe();
    resumes = true;
  }

  // Called after a step of a run that must pause before an observation.
  void watch() {
    if (!inside) return;
    if (std::exchange(resumes, false)) pace.resumed(hurried());
    if (pace.due(simulation.step(), false, hurried())) simulation.pause();
  }

  bool over() {
    if (options.between_steps && !options.between_steps()) wanted.quit = true;
    return simulation.stopped() || wanted.quit;
  }

  /// The next action according to the current requests.
  Deed next() {
    if (over()) return {Deed::end};
    clients.handle_requests();
    if (over()) return {Deed::end};
    if (failure || wanted.nothing()) return idle();
    if (auto const size = std::exchange(wanted.step_size, std::nullopt)) return {Deed::step_size, 0, *size};
    std::int64_t const step = simulation.step();
    if (wanted.goal) return move(*wanted.goal - step);
    if (wanted.command == Command::play) {
      if (step >= plan.target) plan.target = step + std::max<std::int64_t>(plan.steps, 1);
      return move(plan.target - step);
    }
    if (step > plan.first) return move(plan.first - step);
    arrive();
    want(Command::pause);
    return {Deed::wait};
  }

  Deed idle() {
    moving = false;
    clients.send_updates();
    bool const finished = failure || simulation.step() >= plan.target;
    if (options.play && finished && clients.viewers() == 0) return {Deed::end};
    clients.wait(0.1);
    return {Deed::wait};
  }

  Deed move(std::int64_t ahead) {
    if (ahead > 0 || wanted.goal) told.missed = nullptr;
    std::int64_t const steps = std::abs(ahead);
    return {ahead < 0 ? Deed::rewind : Deed::play,
            team.alone() ? steps : std::min(steps, pace.steps_to_frame(hurried()))};
  }

  /// All ranks execute the next action of rank 0.
  Deed together() {
    if (team.alone()) return next();
    Deed deed{Deed::wait};
    std::exception_ptr failed;
    try {
      if (team.first()) deed = next();
    } catch (...) {
      failed = std::current_exception();
    }
    return tell(std::move(deed), failed);
  }

  /// Broadcasts the action of rank 0.
  Deed tell(Deed deed, std::exception_ptr const& failed = nullptr) {
    Team::Ballot ballot{Team::Occasion::between_runs, simulation.stopped()};
    ballot.most.fill(std::numeric_limits<std::int64_t>::min());
    if (team.first()) ballot.most = {deed.what, deed.steps, std::bit_cast<std::int64_t>(deed.size)};
    auto const outcome = team.vote(ballot, failed);
    Team::check(outcome);
    if (outcome.stop) simulation.stop();  // only one rank may have received a signal
    deed = {static_cast<Deed::What>(outcome.most[0]), outcome.most[1], std::bit_cast<double>(outcome.most[2]),
            std::move(deed.request)};
    if (deed.what == Deed::draw || deed.what == Deed::picture) team.broadcast(deed.request);
    return deed;
  }

  /// Called before rank 0 draws between two steps. The other ranks make the same drawing and discard it, because a
  /// drawing may measure, and measuring may exchange rows of neighbours.
  void draw_with_others(Deed::What what, json const& request) {
    if (team.alone()) return;
    tell({what, 0, 0, request.dump(-1, ' ', false, json::error_handler_t::replace)});
  }

  void draw_for_nobody(Deed const& deed) const {
    try {
      json const request = json::parse(deed.request);
      if (deed.what == Deed::draw)
        views.draw(request, simulation.step(), simulation.time());
      else
        views.picture(request, simulation.step(), simulation.time());
    } catch (std::exception const&) {
      // Rank 0 reports the error to the client that requested the action.
    }
  }

  void perform(Deed const& deed) {
    if (deed.what == Deed::draw || deed.what == Deed::picture) draw_for_nobody(deed);
    if (deed.what == Deed::step_size) {
      simulation.step_size(deed.size);
      ++told.notice;
    }
    if (deed.what != Deed::play && deed.what != Deed::rewind) return;
    try {
      go(deed);
    } catch (PhysicsFailure const& physics) {
      failure = std::current_exception();
      told.say(physics.what());
      wanted.pause();
      ++told.scene;
    } catch (Error const& error) {
      told.say(error.what());
      wanted.pause();
    }
  }

  void arrive() {
    if (simulation.step() == plan.first && start.kept()) compare_with_start();
  }

  std::string state_word() const {
    if (wanted.quit) return "ended";
    if (failure) return "failed";
    if (wanted.command == Command::play) return "playing";
    if (wanted.command == Command::rewind) return "rewinding";
    return simulation.step() >= plan.target && simulation.step() > plan.first ? "done" : "paused";
  }

  void set(json const& request) {
    if (request.contains("step_size")) {
      auto const& given = request["step_size"];
      double size = 0;
      if (given.is_number())
        size = given.get<double>();
      else if (given.is_string())
        size = in_units(given.get<std::string>(), dimensions::time, views.units());
      else
        throw Error("the step size is a number or a time with its unit, \"2 fs\"");
      if (!std::isfinite(size) || !(size > 0)) throw Error(fmt::format("the step size is above 0, not {}", size));
      for (auto* scheme : simulation.schemes())
        if (size > 4 * scheme->longest_step())
          throw Error(fmt::format("a step of {} is far above the longest that makes sense, {}",
                                  views.quantity(size, dimensions::time),
                                  views.quantity(scheme->longest_step(), dimensions::time)));
      wanted.step_size = size;
    }
    if (request.contains("steps_per_frame")) {
      double const steps = number_or(request, "steps_per_frame", 0);
      if (!(steps >= 0) || steps > 1e9 || steps != std::floor(steps))
        throw Error("steps_per_frame is a whole number from 0 (full speed) on");
      pace.steps_per_frame(static_cast<std::int64_t>(steps));
    }
    if (!request.contains("step_size") && !request.contains("steps_per_frame"))
      throw Error("only step_size and steps_per_frame can be set");
    ++told.notice;
  }
};

LiveRun::LiveRun(Views& views, Clients& clients, Recording* recording, LiveOptions const& options)
    : state_(std::make_shared<State>(views, clients, recording, options)) {
  if (recording)
    recording->on_row([weak = std::weak_ptr<State>(state_)](std::int64_t step, std::span<double const> values) {
      auto const state = weak.lock();
      if (!state) return;
      std::vector<double> row{static_cast<double>(step)};
      row.insert(row.end(), values.begin(), values.end());
      state->table.add(row);
    });
  Simulation& simulation = views.simulation();
  if (state_->team.alone())
    state_->observer = simulation.observe_when([state = state_.get()](std::int64_t step) { return state->look(step); },
                                               [state = state_.get()](Simulation const&) { state->observe(); });
  else if (state_->team.first())
    state_->observer = simulation.observe_progress([state = state_.get()](Simulation const&) { state->watch(); });
}

LiveRun::~LiveRun() {
  state_->simulation.forget(state_->observer);
  state_->clients.close();
}

void LiveRun::run(std::uint64_t steps) {
  State& state = *state_;
  state.simulation.check();
  state.plan = {state.simulation.step(), state.simulation.step() + static_cast<std::int64_t>(steps),
                static_cast<std::int64_t>(steps)};
  state.pace.steps_per_frame(
      state.options.steps_per_frame >= 0 ? state.options.steps_per_frame
      : state.options.play
          ? 0
          : std::max<std::int64_t>(1, static_cast<std::int64_t>(static_cast<double>(steps) / usual_frames)));
  if (state.options.play && steps > 0) state.wanted.command = Command::play;  // a run at its last step stays there
  state.clients.open(*this);
  for (Deed deed = state.together(); deed.what != Deed::end; deed = state.together()) state.perform(deed);
  state.wanted.quit = true;
  ++state.told.notice;
  state.clients.send_updates();
  // After QUIT before the first step, the folder contains the start of the run, ready to be resumed.
  if (state.recording && !state.begun && !state.failure) state.simulation.run(0);
  if (state.failure) std::rethrow_exception(state.failure);
}

json LiveRun::hello() const {
  State const& state = *state_;
  json result = state.views.describe();
  result["type"] = "hello";
  result["kind"] = "live";
  result["name"] = state.options.name;
  result["description"] = state.options.description;
  result["planned"] = state.plan.target;
  result["steps_per_frame"] = state.pace.steps_per_frame();
  result["can"] = {
      {"rewind", no_rewind(state.simulation)},
      {"step_size", ""},
      {"checkpoint", state.recording ? "" : "this run is not recorded, so it has no folder for a checkpoint"},
      {"seek", "a run in progress has no frames to choose; bzm window DIR replays a stored one"},
      {"quit", ""}};
  return result;
}

json LiveRun::status() const {
  State const& state = *state_;
  bool const moving = state.wanted.command != Command::pause || state.wanted.goal;
  return {{"state", state.state_word()},
          {"step", state.simulation.step()},
          {"time", state.views.quantity(state.simulation.time(), dimensions::time)},
          {"time_number", state.simulation.time()},
          {"planned", state.plan.target},
          {"steps_per_second", moving ? state.pace.steps_per_second() : 0.0},
          {"steps_per_frame", state.pace.steps_per_frame()},
          {"step_size_number", state.simulation.step_size()},
          {"step_size", state.views.quantity(state.simulation.step_size(), dimensions::time)},
          {"message", state.told.message},
          {"missed", state.told.missed}};
}

std::uint64_t LiveRun::scene() const { return state_->told.scene; }
std::uint64_t LiveRun::notice() const { return state_->told.notice; }
ShownTable const* LiveRun::table() const { return &state_->table; }

json LiveRun::perform(json const& request) {
  State& state = *state_;
  std::string const what = request["do"];
  if (what == "quit") {
    state.wanted.quit = true;
    ++state.told.notice;
    return json::object();
  }
  if (what == "stop") {
    state.wanted.goal.reset();
    state.want(Command::pause);
    return json::object();
  }
  bool const moves = what == "play" || what == "step" || what == "rewind";
  if (moves && state.failure) throw Error("the run has failed: " + state.told.message);
  double const count = what == "step" ? number_or(request, "steps", 1) : 0;
  if (what == "step" && (count == 0 || count != std::floor(count) || std::abs(count) > 1e9))
    throw Error("step does a whole number of steps other than 0");
  bool const back = what == "rewind" || count < 0;
  if (back && !no_rewind(state.simulation).empty()) throw Error(no_rewind(state.simulation));
  if (back && state.simulation.step() <= state.plan.first) throw Error("this is where the run began");
  if (moves && !state.told.message.empty()) state.told.say("");
  if (what == "play") {
    state.wanted.goal.reset();
    state.want(Command::play);
  } else if (what == "rewind") {
    state.wanted.goal.reset();
    state.want(Command::rewind);
  } else if (what == "step") {
    state.want(Command::pause);
    // Repeated requests faster than steps are done accumulate; a change of direction resets them.
    std::int64_t const now = state.simulation.step();
    auto& goal = state.wanted.goal;
    bool const again = goal && (*goal > now) == (count > 0);
    goal = std::max((again ? *goal : now) + static_cast<std::int64_t>(count), state.plan.first);
    if (goal == now) goal.reset();
  } else if (what == "set") {
    state.set(request);
  } else if (what == "checkpoint") {
    if (!state.recording) throw Error("this run is not recorded, so it has no folder for a checkpoint");
    return {{"path", state.recording->save_checkpoint()}};
  } else {
    throw Error("a live run can't '" + what +
                "'; it takes play, step, rewind, stop, quit, set, select, views, picture "
                "and checkpoint");
  }
  return json::object();
}

std::shared_ptr<Canvas const> LiveRun::draw(json const& view) {
  state_->draw_with_others(Deed::draw, view);
  return state_->views.draw(view, state_->simulation.step(), state_->simulation.time());
}

PictureFile LiveRun::picture(json const& request) {
  state_->draw_with_others(Deed::picture, request);
  return state_->views.picture(request, state_->simulation.step(), state_->simulation.time());
}

json LiveRun::particle(std::string const& ensemble, std::size_t number) const {
  return state_->views.particle(ensemble, number);
}

RunReport run_live(Views& views, Clients& clients, Recording* recording, std::uint64_t steps,
                   LiveOptions const& options, bool quiet) {
  if (recording) views.take(*recording);
  views.add_usual();
  LiveRun live(views, clients, recording, options);
  ProgressOptions const progress{quiet, 0, true, [&](std::uint64_t n) { live.run(n); }};
  if (!recording) return run_with_progress(views.simulation(), steps, progress);
  std::optional<AddressFile> address;
  if (team().first()) address.emplace(recording->folder(), clients.address());
  return run_with_progress(*recording, steps, progress);
}

}  // namespace boltzmann
