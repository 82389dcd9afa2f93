// Loads a frame into the ensembles, and then draws as if a run had just reached it.
#include <boltzmann/core/clock.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/files/csv.hpp>
#include <boltzmann/recording/interrupt.hpp>
#include <boltzmann/window/clients.hpp>
#include <boltzmann/window/replay.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

namespace boltzmann {
namespace {

using nlohmann::json;

constexpr double fastest = 240;                                 // frames per second
constexpr auto steps_between_clocks = std::chrono::seconds(1);  // of the file, which may grow

}  // namespace

Replay::Replay(Views& views, std::string name, std::string description)
    : views_(views),
      name_(std::move(name)),
      description_(std::move(description)),
      path_(views.folder() + "/trajectory.h5") {
  std::error_code ignored;  // the reader reports errors
  written_ = std::filesystem::last_write_time(path_, ignored);
  take(std::make_unique<TrajectoryReader>(path_));
  if (steps_.empty()) throw Error("'" + path_ + "' has no frames");
  read_table();
  go_to(0);
}

void Replay::read_table() {
  std::string const path = views_.folder() + "/diagnoses.csv";
  if (!std::filesystem::exists(path)) return;
  CsvTable const stored = read_csv(path);
  views_.columns(stored.header);
  ShownTable fresh;
  fresh.number = table_.number;
  std::size_t const rows = stored.columns.empty() ? 0 : stored.columns[0].size();
  // Every n-th row, so that the page can draw them all.
  std::size_t const stride = rows / ShownTable::most + 1;
  for (std::size_t r = 0; r < rows; r += stride) {
    std::vector<double> row;
    for (auto const& column : stored.columns) row.push_back(column[r]);
    fresh.add(row);
  }
  bool const grown = fresh.values.size() >= table_.values.size() && stride == 1 &&
                     std::equal(table_.values.begin(), table_.values.end(), fresh.values.begin());
  if (!grown) ++fresh.number;
  table_ = std::move(fresh);
}

void Replay::go_to(std::int64_t frame) {
  if (!reader_) throw Error("'" + path_ + "' can't be read at the moment");
  std::int64_t const wanted = std::clamp<std::int64_t>(frame, 0, frames() - 1);
  auto const fill = [&](std::int64_t with) {
    for (auto* scheme : views_.simulation().schemes()) reader_->load(static_cast<std::size_t>(with), scheme->box());
    for (auto* scheme : views_.simulation().schemes())
      for (auto* ensemble : scheme->ensembles()) reader_->load(static_cast<std::size_t>(with), *ensemble);
  };
  try {
    fill(wanted);
  } catch (Error const&) {  // damaged, or incomplete because it is being written; retry later
    written_ = {};
    try {
      fill(frame_);
    } catch (Error const&) {
      // the message about the requested frame contains it
    }
    throw;
  }
  frame_ = wanted;
  message_.clear();
  ++scene_;
}

// A run in another program may add frames. HDF5 would return the old contents of a file that is already open, so it is
// closed first.
void Replay::look_for_more() {
  std::error_code error;
  auto const written = std::filesystem::last_write_time(path_, error);
  if (error || (written == written_ && reader_)) return;
  std::int64_t const before = frames();
  reader_.reset();
  try {
    auto longer = std::make_unique<TrajectoryReader>(path_);
    if (static_cast<std::int64_t>(longer->frames()) < before) {  // replaced by another run
      longer.reset();
      return;
    }
    take(std::move(longer));
    written_ = written;
    if (frames() == before) return;
    read_table();
    ++notice_;
  } catch (Error const&) {
    // the file is being written; retry later
  }
}

void Replay::take(std::unique_ptr<TrajectoryReader> reader) {
  reader_ = std::move(reader);
  steps_ = reader_->steps();
  times_ = reader_->times();
}

bool Replay::run(Clients& clients) {
  Interrupt const interrupt(views_.simulation());
  struct Shown {
    Clients& clients;
    Shown(Clients& all, Source& source) : clients(all) { clients.open(source); }
    ~Shown() { clients.close(); }
  } const shown(clients, *this);
  auto next_frame = Clock::now(), next_look = Clock::now() + steps_between_clocks;
  while (!quit_ && !interrupt.seen()) {
    clients.handle_requests();
    auto const now = Clock::now();
    if (now >= next_look) {
      look_for_more();
      next_look = now + steps_between_clocks;
    }
    if (direction_ != 0 && now >= next_frame) {
      std::int64_t const wanted = frame_ + direction_;
      if (wanted < 0 || wanted >= frames()) {
        direction_ = 0;
        ++notice_;
      } else {
        try {
          if (reader_) go_to(wanted);
        } catch (Error const& error) {
          direction_ = 0;
          message_ = error.what();
          ++notice_;
        }
        next_frame = std::max(next_frame + clock_time(1 / frames_per_second_), now);
      }
    }
    clients.send_updates();
    double const idle = direction_ == 0 ? 0.1 : seconds_between(Clock::now(), next_frame);
    if (idle > 0) clients.wait(std::min(idle, 0.1));
    if (direction_ == 0) next_frame = Clock::now();
  }
  ++notice_;
  clients.send_updates();
  return interrupt.seen();
}

json Replay::hello() const {
  json result = views_.describe();
  std::string const stored = "this is a stored run; bzm resume continues it";
  result["type"] = "hello";
  result["kind"] = "replay";
  result["name"] = name_;
  result["description"] = description_;
  result["planned"] = steps_.back();
  result["steps_per_frame"] = frames_per_second_;
  result["can"] = {{"rewind", ""}, {"step_size", stored}, {"checkpoint", stored}, {"seek", ""}, {"quit", ""}};
  return result;
}

json Replay::status() const {
  bool const end = frame_ + 1 == frames();
  return {{"state", quit_            ? "ended"
                    : direction_ > 0 ? "playing"
                    : direction_ < 0 ? "rewinding"
                    : end            ? "done"
                                     : "paused"},
          {"step", step()},
          {"time", views_.quantity(time(), dimensions::time)},
          {"time_number", time()},
          {"planned", steps_.back()},
          {"steps_per_second", 0},
          {"steps_per_frame", frames_per_second_},
          {"frame", frame_},
          {"frames", frames()},
          {"message", message_},
          {"missed", nullptr}};
}

json Replay::perform(json const& request) {
  std::string const what = request["do"];
  if (what == "play") {
    if (frame_ + 1 == frames()) go_to(0);
    direction_ = 1;
  } else if (what == "rewind") {
    if (frame_ == 0) throw Error("this is the first frame");
    direction_ = -1;
  } else if (what == "stop") {
    direction_ = 0;
  } else if (what == "quit") {
    quit_ = true;
  } else if (what == "step") {
    direction_ = 0;
    go_to(frame_ + static_cast<std::int64_t>(std::clamp(number_or(request, "steps", 1), -1e15, 1e15)));
  } else if (what == "seek") {
    double const frame = number_or(request, "frame", -1);
    if (!(frame >= 0) || frame >= static_cast<double>(frames()))
      throw Error(fmt::format("there are frames 0 to {}", frames() - 1));
    go_to(static_cast<std::int64_t>(frame));
  } else if (what == "set") {
    double const rate = number_or(request, "steps_per_frame", 0);
    if (!request.contains("steps_per_frame"))
      throw Error("of a stored run only the frames per second can be set, as steps_per_frame");
    if (!(rate > 0)) throw Error(fmt::format("a replay shows up to {} frames per second, not {}", fastest, rate));
    frames_per_second_ = std::min(rate, fastest);
  } else {
    throw Error("a stored run can't '" + what +
                "'; it takes play, step, rewind, stop, seek, quit, set, select, views and "
                "picture");
  }
  ++notice_;
  return json::object();
}

std::shared_ptr<Canvas const> Replay::draw(json const& view) { return views_.draw(view, step(), time()); }
PictureFile Replay::picture(json const& request) { return views_.picture(request, step(), time()); }
json Replay::particle(std::string const& ensemble, std::size_t number) const {
  return views_.particle(ensemble, number);
}

}  // namespace boltzmann
