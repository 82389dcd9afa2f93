// bzm build: a user's program compiles with the printed line, fast, and runs.
#include "tests/bzm/command.hpp"

#include <cstdio>

namespace boltzmann::build_test {
namespace {

using namespace boltzmann::test;

constexpr char const* program = R"cpp(
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/recording/recording.hpp>

  using namespace boltzmann;

  int main() try {
    UnitSystem const units(units::angstrom, units::amu, units::picosecond);
    double const r0 = units(2.551 * units::angstrom);
    Ensemble<Newton<2>> atoms("atoms");
    block_load(atoms, {Lattice::triangular, r0, {16, 16}, {20, 20}});
    for (auto& atom : atoms) atom.mass = units(63.546 * units::amu);
    atoms[100].velocity = {10., 5.};

    PairScheme copper(Box(Vector{0., 0.}, Vector{80., 80.}), 3 * r0);
    copper.internal(atoms, LennardJones{units(0.1 * units::electronvolt), r0});
    Simulation simulation(copper, units(2 * units::femtosecond));
    simulation.integrate(atoms, Method::leap_frog);

    Recording recording(simulation, units, "results");
    recording.diagnoses(10, {"energies", "temperature"});
    recording.trajectory(50);
    recording.picture({.colour = "speed"});
    run_with_progress(recording, 100);
  } catch (std::exception const& error) {
    return report(error);
  }
)cpp";

TEST(Build, CompilesAndTheProgramLeavesTheSameFilesAsBzm) {
  Folder folder;
  write_text(folder / "copper.cpp", program);
  auto const built = bzm({"build", "copper.cpp"}, folder.string());
  ASSERT_EQ(built.status, 0) << built.err;
  for (auto const* word : {"-std=c++20", "-O3", "-march=native", "-lboltzmann", "copper.cpp -o copper"})
    EXPECT_NE(built.out.find(word), std::string::npos) << built.out;
  auto const at = built.out.find(" built in ");
  ASSERT_NE(at, std::string::npos) << built.out;
  double const seconds = std::stod(built.out.substr(at + 10));
  RecordProperty("compile_seconds", std::to_string(seconds));
  std::printf("a user's program of 35 lines compiles in %.1f s\n", seconds);

  auto const ran = Process({(folder / "copper").string()}, folder.string()).wait();
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.out.find("particle-steps/s"), std::string::npos) << ran.out;
  for (auto const* file : {"diagnoses.csv", "trajectory.h5", "checkpoint.h5", "picture.png"})
    EXPECT_TRUE(fs::exists(folder / (std::string("results/") + file))) << file;
  // Once more into the same folder: refused, with the user's exit status.
  auto const again = Process({(folder / "copper").string()}, folder.string()).wait();
  EXPECT_EQ(again.status, 2);
  EXPECT_NE(again.err.find("already holds a run"), std::string::npos) << again.err;
}

TEST(Build, TellsOfMistakes) {
  Folder folder;
  auto const missing = bzm({"build", "nowhere.cpp"}, folder.string());
  EXPECT_EQ(missing.status, 2);
  EXPECT_NE(missing.err.find("nowhere.cpp"), std::string::npos);
  write_text(folder / "wrong.cpp", "int main() { return nothing; }\n");
  auto const wrong = bzm({"build", "wrong.cpp"}, folder.string());
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.err.find("does not compile"), std::string::npos) << wrong.err;
  EXPECT_FALSE(fs::exists(folder / "wrong"));
}

// What a law on packs may not do is said in one line at the end.
TEST(Build, HintsAtWhatALawMeans) {
  Folder folder;
  auto const hint = [&](std::string const& body) {
    write_text(folder / "law.cpp",
               "#include <boltzmann/core/pack_math.hpp>\n#include <boltzmann/laws/interaction.hpp>\n"
               "using namespace boltzmann;\n"
               "struct Law { template <class P> auto operator()(P x) const { " +
                   body +
                   " } };\n"
                   "int main() { (void)Law{}(1.0); Law{}(Pack<double>(1.0)); }\n");
    auto const built = bzm({"build", "law.cpp"}, folder.string());
    EXPECT_EQ(built.status, 2) << built.err;
    auto const at = built.err.find("\nhint: ");
    if (at == std::string::npos) return "no hint in " + built.err;
    return built.err.substr(at + 7, built.err.find('\n', at + 1) - at - 6);
  };
  EXPECT_EQ(hint("return std::exp(x);"),
            "in a law write exp without std:: (a law is compiled for several particles at once)\n");
  EXPECT_EQ(hint("return std::pow(std::sqrt(x), 2);"),
            "in a law write sqrt without std:: (a law is compiled for several particles at once)\n");
  EXPECT_EQ(hint("if (x < 2.0) return x; return P(0.0);"),
            "of several particles at once there is no `if`: write select(condition, a, b)\n");
  EXPECT_EQ(hint("return Interaction{x, Vector<3, P>{x, x, x}};"),
            "an Interaction is {force, energy}, in this order\n");
}

}  // namespace
}  // namespace boltzmann::build_test
