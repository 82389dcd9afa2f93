// What a window costs: the frames per second that a reading browser gets of a simulation at full speed, how much slower
// the simulation is for it, and for a browser that never reads. A browser is a socket here, which reads and asks for
// the next frame at once. The simulation runs on one thread; rounds without, with a reading and with a silent browser
// in turns; medians of the ratios of neighbouring rounds.
//
//   bench_window [seconds of a round]      2 unless told otherwise
#include <boltzmann/boltzmann.hpp>
#include <boltzmann/window/window.hpp>

#include "timing.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <tests/window/web_client.hpp>
#include <thread>
#include <vector>

namespace {

using namespace boltzmann;
using nlohmann::json;
using Clock = std::chrono::steady_clock;

// A browser that reads as fast as it can, or takes nothing after its first word.
class Browser {
 public:
  Browser(Window const& window, std::size_t most, bool reads) : socket_(port(window), token(window)) {
    json const view{{"id", 1}, {"diagnosis", "Particles"}, {"colour", "speed"}, {"most", most}};
    say({{"do", "views"}, {"views", json::array({view})}});
    next();
    if (reads) thread_ = std::thread([this] { read(); });
  }
  ~Browser() {
    socket_.connection().shut();
    if (thread_.joinable()) thread_.join();
  }
  Browser(Browser const&) = delete;
  Browser& operator=(Browser const&) = delete;

  void say(json const& request) { socket_.say(request.dump()); }
  std::atomic<std::int64_t> frames = 0, bytes = 0;

 private:
  static std::uint16_t port(Window const& window) {
    return static_cast<std::uint16_t>(std::atoi(window.address().c_str() + std::string("http://127.0.0.1:").size()));
  }
  static std::string token(Window const& window) {
    std::string const address = window.address();
    return address.substr(address.find("token=") + 6);
  }
  void next() { socket_.say(R"({"do":"next","rows":0,"table":-1})"); }
  void read() {
    std::vector<char> buffer;
    for (;;) {
      auto const got = socket_.receive(buffer);
      if (got.kind == WebReceived::Kind::closed || got.kind == WebReceived::Kind::nothing) return;
      if (got.kind != WebReceived::Kind::binary) continue;
      ++frames;
      bytes += static_cast<std::int64_t>(got.bytes);
      next();
    }
  }
  WebSocketClient socket_;
  std::thread thread_;
};

// Electrons on a mesh: a step takes some ns a particle. Their rows must be brought up to date for each frame.
struct Plasma {
  Ensemble<Coulomb<2>> electrons;
  std::unique_ptr<MeshScheme> mesh;
  std::unique_ptr<Simulation> simulation;

  explicit Plasma(std::size_t count) : electrons("electrons", count) {
    std::size_t const cells = 128;
    Box const box(Vector{0.0, 0.0}, Vector{128.0, 128.0}, Boundary::periodic);
    for (auto& electron : electrons) {
      electron.mass = box.volume() / static_cast<double>(count);
      electron.charge = -electron.mass / std::sqrt(4 * pi);
    }
    random_load(electrons, box);
    maxwellian_load(electrons, {.temperature = electrons[0].mass});
    mesh = std::make_unique<MeshScheme>(box, std::vector<std::size_t>{cells, cells}, coulomb(1));
    mesh->add(electrons);
    mesh->background(true);
    simulation = std::make_unique<Simulation>(*mesh, 0.1);
    simulation->integrate(electrons, Method::leap_frog);
    simulation->threads(1);
  }
};

// Atoms of a liquid, with neighbour lists.
struct Liquid {
  Ensemble<Newton<2>> atoms;
  std::unique_ptr<PairScheme> scheme;
  std::unique_ptr<Simulation> simulation;

  explicit Liquid(std::size_t count) : atoms("atoms", count) {
    auto const side = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(count))));
    double const length = 1.1 * static_cast<double>(side);
    block_load(atoms, {Lattice::square, 1.1, {side, side}, {0.5, 0.5}});
    maxwellian_load(atoms, {.temperature = 1});
    scheme = std::make_unique<PairScheme>(Box(Vector{0.0, 0.0}, Vector{length, length}, Boundary::periodic), 2.5);
    scheme->internal(atoms, LennardJones{1, 1});
    simulation = std::make_unique<Simulation>(*scheme, 0.002);
    simulation->integrate(atoms, Method::leap_frog);
    simulation->threads(1);
  }
};

template <class System>
void report(char const* name, std::size_t count, double seconds) {
  System system(count);
  Window window(*system.simulation, UnitSystem::reduced(), {.quiet = true});
  std::thread run([&] { window.run(1'000'000'000'000); });
  Browser control(window, 1, false);  // has had its first frame, and asks for no other
  control.say({{"do", "set"}, {"steps_per_frame", 0}});
  control.say({{"do", "play"}});
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  auto const rate = [&] {
    auto const start = Clock::now();
    auto const first = system.simulation->step();
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
    return static_cast<double>(system.simulation->step() - first) /
           std::chrono::duration<double>(Clock::now() - start).count();
  };
  std::vector<double> alone, slower, silent_slower, frames, megabytes;
  for (int round = 0; round < 5; ++round) {
    double const before = rate();
    {
      Browser const reading(window, count, true);
      auto const start = Clock::now();
      double const with = rate();
      double const passed = std::chrono::duration<double>(Clock::now() - start).count();
      frames.push_back(static_cast<double>(reading.frames) / passed);
      megabytes.push_back(static_cast<double>(reading.bytes) /
                          std::max<double>(1, static_cast<double>(reading.frames)) / 1e6);
      slower.push_back(with);
    }
    double const between = rate();
    {
      Browser const silent(window, count, false);
      silent_slower.push_back(rate());
    }
    double const after = rate();
    alone.push_back(between);
    slower.back() = 1 - slower.back() / (0.5 * (before + between));
    silent_slower.back() = 1 - silent_slower.back() / (0.5 * (between + after));
  }
  control.say({{"do", "quit"}});
  run.join();
  std::printf(
      "%-8s %9zu particles  %8.1f steps/s alone   %5.1f frames/s of %5.2f MB   slower by %5.1f %%   silent browser "
      "%5.1f %%\n",
      name, count, median(alone), median(frames), median(megabytes), 100 * median(slower), 100 * median(silent_slower));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  double const seconds = argc > 1 ? std::atof(argv[1]) : 2;
  report<Liquid>("liquid", 100'489, seconds);  // 317 x 317
  report<Liquid>("liquid", 1'000'000, seconds);
  report<Plasma>("plasma", 100'000, seconds);
  report<Plasma>("plasma", 1'000'000, seconds);
}
