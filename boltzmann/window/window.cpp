// Combines the views of a simulation, the clients, and the run.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/team.hpp>
#include <boltzmann/pictures/colour.hpp>
#include <boltzmann/recording/recording.hpp>
#include <boltzmann/window/address_file.hpp>
#include <boltzmann/window/live_run.hpp>
#include <boltzmann/window/window.hpp>

#include <optional>

namespace boltzmann {
struct Window::State {
  Recording* recording;
  WindowOptions options;
  Views views;
  Clients clients;
  std::optional<Announcement> announcement;

  State(Simulation& simulation, UnitSystem const& units, Recording* the_recording, WindowOptions the_options,
        std::string title, std::string folder)
      : recording(the_recording),
        options(std::move(the_options)),
        views(simulation, units, std::move(title), std::move(folder)),
        clients(options.port) {
    simulation.check();
    if (!options.quiet && team().first()) announcement.emplace("window", clients.address());
  }
};

Window::Window(Recording& recording, WindowOptions options) {
  std::string const title = options.title.empty() ? recording.title() : options.title;
  state_ = std::make_unique<State>(recording.simulation(), recording.units(), &recording, std::move(options), title,
                                   recording.folder());
}

Window::Window(Simulation& simulation, UnitSystem const& units, WindowOptions options) {
  std::string const title = options.title;
  state_ = std::make_unique<State>(simulation, units, nullptr, std::move(options), title, "");
}

Window::~Window() { state_->clients.bye("the program has closed the window"); }

void Window::install_drawing(std::string name, std::function<void(Canvas&)> draw) {
  if (name.empty()) throw Error("a diagnosis needs a name");
  state_->views.install(std::move(name), std::move(draw));
}

void Window::add(std::string name, Picture picture) {
  if (name.empty()) throw Error("a diagnosis needs a name");
  state_->views.add(std::move(name), std::move(picture), Views::Unfit::throws);
}

void Window::colours(std::vector<std::string> const& names) {
  std::vector<Colour> palette;
  for (auto const& name : names) palette.push_back(colour_named(name));
  state_->views.palette(std::move(palette));
}

std::string Window::address() const { return state_->clients.address(); }
Simulation& Window::simulation() const { return state_->views.simulation(); }

RunReport Window::run(std::uint64_t steps) {
  State& state = *state_;
  return run_live(state.views, state.clients, state.recording, steps,
                  {state.options.play, -1, state.options.name, state.options.description}, state.options.quiet);
}

}  // namespace boltzmann
