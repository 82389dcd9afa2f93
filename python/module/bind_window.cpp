// A window on a simulation from Python: a thread of Python's runs it as somebody at the page wants.
#include "core.hpp"

#include <boltzmann/core/team.hpp>

#ifdef BOLTZMANN_WITH_WINDOW
#include <boltzmann/window/live_run.hpp>
#include <boltzmann/window/replay_page.hpp>
#endif

#include <pybind11/stl.h>

namespace boltzmann::python {

#ifdef BOLTZMANN_WITH_WINDOW
namespace {

class LiveWindow {
 public:
  LiveWindow(Core& core, std::uint16_t port)
      : core_(core),
        views_(core.simulation(), core.scenario().units,
               core.scenario().title.empty() ? core.scenario().name : core.scenario().title, core.folder()),
        clients_(port) {
    if (!team().alone()) throw Error("a window of Python shows a run on one rank; leave it or the other ranks out");
    for (auto const& view : core.scenario().views) views_.add(view.name, view);
  }

  std::string address() const { return clients_.address(); }
  void close() {
    closed_ = true;
    core_.stop();
  }
  /// Until somebody quits.
  void serve(std::int64_t steps, bool play) {
    core_.attended([&](Recording* recording) {
      LiveOptions options{play, -1, core_.scenario().name, core_.scenario().description, [this] {
                            core_.after_step();
                            return !closed_;
                          }};
      run_live(views_, clients_, recording, static_cast<std::uint64_t>(steps), options, true);
    });
    clients_.bye("Python has closed the window");
  }

 private:
  Core& core_;
  Views views_;
  Clients clients_;
  std::atomic<bool> closed_ = false;
};

}  // namespace

void bind_window(py::module_& module) {
  py::class_<LiveWindow>(module, "LiveWindow")
      .def(py::init<Core&, std::uint16_t>(), py::keep_alive<1, 2>())
      .def("address", &LiveWindow::address)
      .def("close", &LiveWindow::close)
      .def("serve", &LiveWindow::serve);
  module.def("replay_page", [](std::string const& folder, std::vector<std::string> const& views, std::size_t frames,
                               double megabytes) {
    look_for_h5py();
    auto const page = replay_page(folder, {views, frames, megabytes});
    return py::make_tuple(page.html, page.frames, page.stored_frames, page.message);
  });
}
#else
void bind_window(py::module_& module) {
  auto const none = [](py::args const&) -> py::object {
    throw Error("this library was built without the window: libboost-dev and nlohmann-json3-dev were not there");
  };
  module.def("LiveWindow", none);
  module.def("replay_page", none);
}
#endif

}  // namespace boltzmann::python
