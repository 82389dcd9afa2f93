// Replaces window.cpp if the dependencies of the window are not installed.
#include <boltzmann/bzm/commands.hpp>
#include <boltzmann/bzm/run_recording.hpp>

namespace boltzmann::bzm {
namespace {

[[noreturn]] void refuse() {
  throw Error("this bzm was built without the window; install libboost-dev and nlohmann-json3-dev, and build it again");
}

}  // namespace

int window(WindowCommand const&) { refuse(); }
RunReport run_in_window(ScenarioSimulation const&, Recording&, std::int64_t, WindowRun const&, bool) { refuse(); }

}  // namespace boltzmann::bzm
