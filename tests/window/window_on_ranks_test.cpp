// A window on a run of several ranks, which are threads here: rank 0 shows it, all do what its pages want, and have the bits
// of one rank that nobody looks at.
#include "tests/thread_team.hpp"

#include <gtest/gtest.h>
#include <boltzmann/boltzmann.hpp>
#include <boltzmann/recording/interrupt.hpp>
#include <boltzmann/window/window.hpp>

#include <future>
#include <memory>
#include <tests/window/reader.hpp>
#include <thread>

namespace boltzmann::window_on_ranks_test {
namespace {

using nlohmann::json;

// 216 hot atoms, whose lists are built again every few steps.
struct Atoms {
  Ensemble<Newton<3>> atoms{"atoms"};
  PairScheme scheme{Box(Vector{0.0, 0.0, 0.0}, Vector{6.72, 6.72, 6.72}, Boundary::periodic), 2.5};
  std::unique_ptr<Simulation> simulation;

  Atoms() {
    for (int i = 0; i < 216; ++i) {
      Newton<3> atom{};
      atom.mass = 1;
      for (int a = 0, rest = i; a < 3; ++a, rest /= 6) {
        atom.position[a] = 1.12 * (0.5 + rest % 6);
        atom.velocity[a] = 3 * std::sin(1.7 * i + a);
      }
      atoms.add(atom);
    }
    scheme.internal(atoms, LennardJones{1, 1});
    simulation = std::make_unique<Simulation>(scheme, 0.002);
    simulation->divide_from(0);
  }
  std::vector<double> rows() const { return {atoms.row(0), atoms.row(0) + atoms.size() * atoms.stride()}; }
};

/// Ranks that run in a window, and what is left of them.
class Ranks {
 public:
  Ranks(int ranks, std::uint64_t steps, std::function<void(Atoms&, Window&)> const& also = {})
      : rows(static_cast<std::size_t>(ranks)), thread_([this, ranks, steps, also] {
          test::ThreadTeam team(ranks);
          thrown = team.run([&](Team& here) {
            Atoms system;
            Window window(*system.simulation, UnitSystem::reduced(), {.quiet = true});
            if (also) also(system, window);
            if (here.first()) address_.set_value(window.address());
            window.run(steps);
            rows[static_cast<std::size_t>(here.rank())] = system.rows();
          });
        }) {}
  ~Ranks() {
    if (!thread_.joinable()) return;
    thread_.join();
    for (auto const& each : thrown) EXPECT_EQ(test::line_of(each), "");
  }
  std::string address() { return address_.get_future().get(); }
  void join() { thread_.join(); }

  std::vector<std::vector<double>> rows;
  std::vector<std::exception_ptr> thrown;

 private:
  SignalWatch signals_;  // so that each thread may run what a signal stops
  std::promise<std::string> address_;
  std::thread thread_;
};

class WindowOfRanks : public testing::TestWithParam<int> {};

TEST_P(WindowOfRanks, AllDoWhatAPageWantsAndLookingChangesNoBit) {
  Ranks ranks(GetParam(), 20);
  {
    std::string const address = ranks.address();
    PageReader page(address);
    page.show(json::array({{{"id", 1}, {"diagnosis", "Particles"}, {"colour", "potential-energy"}}}));
    page.ask({{"do", "step"}, {"steps", 7}});
    auto const seventh = page.until([](json const& u) { return u["step"] == 7; });
    EXPECT_EQ(seventh.head["state"], "paused");
    page.ask({{"do", "set"}, {"step_size", 0.001}});
    EXPECT_TRUE(page.ask({{"do", "set"}, {"step_size", -1}}).contains("error"));
    {
      PageReader other(address);
      other.show(json::array({{{"id", 1}, {"diagnosis", "Phase space"}}}));
      other.ask({{"do", "step"}, {"steps", 5}});
      page.until([](json const& u) { return u["step"] == 12; });
    }
    page.ask({{"do", "set"}, {"steps_per_frame", 6}});
    page.ask({{"do", "play"}});
    auto const done = page.until_state("done");
    EXPECT_EQ(done.head["step"], 20);
    EXPECT_EQ(done.head["step_size_number"], 0.001);
    page.ask({{"do", "rewind"}});
    page.until([](json const& u) { return u["step"] == 0; });
    page.ask({{"do", "set"}, {"steps_per_frame", 0}});
    page.ask({{"do", "play"}});
    page.until_state("done");
    page.ask({{"do", "quit"}});
  }
  ranks.join();
  Atoms alone;
  alone.simulation->run(7);
  alone.simulation->step_size(0.001);
  alone.simulation->run(13);
  alone.simulation->rewind(20);
  alone.simulation->run(20);
  for (int r = 0; r < GetParam(); ++r) {
    EXPECT_EQ(test::line_of(ranks.thrown[static_cast<std::size_t>(r)]), "");
    EXPECT_TRUE(ranks.rows[static_cast<std::size_t>(r)] == alone.rows()) << "rank " << r;
  }
}

INSTANTIATE_TEST_SUITE_P(Teams, WindowOfRanks, testing::Values(2, 3));

TEST(WindowOnRanks, AFailureIsShownAndEndsAllWhenThePageQuits) {
  Ranks ranks(2, 1000, [](Atoms& system, Window&) {
    system.simulation->adapt(10, [&system] { system.atoms[100].velocity = {1e9, 0, 0}; });
  });
  PageReader page(ranks.address());
  page.ask({{"do", "play"}});
  auto const failed = page.until_state("failed");
  EXPECT_EQ(std::string(failed.head["message"]).rfind("step 11: ", 0), 0U) << failed.head["message"];
  EXPECT_TRUE(page.ask({{"do", "play"}}).contains("error"));
  page.ask({{"do", "quit"}});
  ranks.join();
  for (auto const& thrown : ranks.thrown) EXPECT_EQ(test::line_of(thrown), failed.head["message"]);
}

TEST(WindowOnRanks, DrawingsOfOnesOwnMayMeasure) {
  std::atomic<int> drawn{0};
  Ranks ranks(2, 20, [&](Atoms& system, Window& window) {
    window.install("Energy", [&](Canvas& canvas) {
      ++drawn;
      canvas.point(0, system.simulation->measure().potential);
    });
  });
  PageReader page(ranks.address());
  page.show(json::array({{{"id", 1}, {"diagnosis", "Energy"}}}));
  page.ask({{"do", "set"}, {"steps_per_frame", 10}});
  page.ask({{"do", "play"}});
  page.until_state("done");
  page.ask({{"do", "quit"}});
  ranks.join();
  EXPECT_GE(drawn, 2) << "on each rank";
  Atoms alone;
  alone.simulation->run(20);
  EXPECT_TRUE(ranks.rows[0] == alone.rows());
  EXPECT_TRUE(ranks.rows[1] == alone.rows());
}

}  // namespace
}  // namespace boltzmann::window_on_ranks_test
