// Shocks and slabs that can't be: no piston, windows that don't fit, too few bins, names that break tables.
#include <boltzmann/diagnoses/shock.hpp>
#include <boltzmann/diagnoses/slab.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/meso.hpp>

#include <tests/message.hpp>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace boltzmann::shock_misuse_test {
namespace {

/// A gas of 2000 particles of temperature 1 between two ends, which a wall may run into.
struct Gas {
  Box box{Vector{0.0, 0.0}, Vector{100.0, 10.0}, {Boundary::reflecting, Boundary::periodic}};
  Ensemble<Meso<2>> lumps{"lumps", 2000};
  std::vector<AnyEnsemble*> all{&lumps};
  std::vector<AnyEnsemble const*> available{&lumps};

  explicit Gas(double drift = 0, std::uint64_t seed = 1) {
    random_load(lumps, box, {.seed = seed});
    maxwellian_load(lumps, {.temperature = 1, .seed = seed});
    for (auto& lump : lumps) lump.velocity[0] += drift;
  }
  /// What the first look says, and the check before it, too.
  std::string look(ShockOptions const& options) {
    std::string const said = message([&] {
      Shock shock(available, options);
      std::vector<double> values;
      shock.measure(Sample{all, box, nullptr, 1, 0, 0}, values);
    });
    EXPECT_EQ(message([&] { Shock(available, options).check(available, box, 1); }), said);
    return said;
  }
};

std::string const no_wall =
    "no wall at an end of x runs into the matter; set end = \"low\" or \"high\", the end from which the shock comes";

// The mean velocity of 2000 particles of mass 1 and temperature 1 is 0 +- 0.022: a wall at rest does not run into them.
TEST(ShockMisuse, NoiseIsNoPiston) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Gas gas(0, seed);
    gas.box.wall(0, Box::End::low, {.velocity = {0, 0, 0}});
    gas.box.wall(0, Box::End::high, {.velocity = {0, 0, 0}});
    EXPECT_EQ(gas.look({}), no_wall) << seed;
    EXPECT_EQ(gas.look({.end = Box::End::high}), "no error");
  }
}

TEST(ShockMisuse, SlowPistonsAndMovingMatterAreTold) {
  for (double const speed : {0.3, 3.0}) {
    Gas slow;
    slow.box.wall(0, Box::End::low, {.velocity = {speed, 0, 0}});
    EXPECT_EQ(slow.look({}), "no error");
    slow.box.wall(0, Box::End::low, {.velocity = {-speed, 0, 0}});
    EXPECT_EQ(slow.look({}), no_wall);
    Gas thrown(-speed);  // against a wall at rest
    thrown.box.wall(0, Box::End::low, {.velocity = {0, 0, 0}});
    EXPECT_EQ(thrown.look({}), "no error");
  }
}

TEST(ShockMisuse, WindowsThatDoNotFitAreToldAtTheStart) {
  Gas gas;
  gas.box.wall(0, Box::End::low, {.velocity = {3, 0, 0}});
  EXPECT_NE(gas.look({.margin = 1e300}).find("the windows of a shock need"), std::string::npos);
  EXPECT_NE(gas.look({.margin = 30}).find("but the matter is"), std::string::npos);
  EXPECT_NE(gas.look({.near = 90}).find("and the distance 90 behind the front, but the matter is"), std::string::npos)
      << gas.look({.near = 90});
  EXPECT_EQ(gas.look({.near = 60}), "no error");
  EXPECT_EQ(gas.look({.margin = 10, .near = 20, .far = 40}), "no error");
}

TEST(ShockMisuse, AFewBinsShowNoFront) {
  Gas gas;
  gas.box.wall(0, Box::End::low, {.velocity = {3, 0, 0}});
  EXPECT_EQ(gas.look({.count = 1}), "a shock does not show in 1 bin; at least 5 are needed");
  EXPECT_EQ(gas.look({.count = 4}), "a shock does not show in 4 bins; at least 5 are needed");
  EXPECT_EQ(gas.look({.count = 5}), "no error");
}

TEST(SlabMisuse, LabelsAreOneLine) {
  Gas gas;
  auto const made = [&](std::string const& label) { return message([&] { Slab(gas.available, {.label = label}); }); };
  EXPECT_NE(made("a\nb").find("a slab's label"), std::string::npos);
  EXPECT_NE(made(std::string("a\0b", 3)).find("control characters"), std::string::npos);
  EXPECT_EQ(made("a, \"b\" °"), "no error");
}

}  // namespace
}  // namespace boltzmann::shock_misuse_test
