// [output] units: results in units of one's choice.
#include <boltzmann/files/csv.hpp>
#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/scenario/scenario_recording.hpp>
#include <tests/message.hpp>

#include <gtest/gtest.h>

#include <filesystem>

namespace boltzmann::output_units_test {
namespace {

std::string scenario_of(std::string const& units, std::string const& base =
                                                      "base = \"custom\"\nlength = \"1 nm\"\nmass = "
                                                      "\"1 amu\"\ntime = \"1 ps\"\n") {
  return "[units]\n" + base +
         "[box]\nlow = [0, 0, 0]\nhigh = [9, 9, 9]\n[run]\nstep = 0.001\nsteps = 4\n[[ensembles]]\nname = "
         "\"atoms\"\nclass = "
         "\"Newton\"\nmass = 40\nvelocity = [1, 0, 0]\nload = { kind = \"positions\", positions = [[1, 1, 1], [2, 2, "
         "2]] }\n"
         "[[diagnoses]]\nkind = \"energies\"\n[output]\ndiagnoses = 1\ntrajectory = 1\n" +
         units;
}

TEST(OutputUnits, AreThoseOfTablesAndTrajectories) {
  auto const folder = std::filesystem::path(testing::TempDir()) / "boltzmann_output_units";
  std::filesystem::remove_all(folder);
  auto const scenario = parse_scenario(
      scenario_of(
          "units = { energy = \"kcal/mol\", length = \"angstrom\", velocity = \"angstrom/ps\", time = \"fs\" }\n"),
      "u.toml");
  auto recording = make_recording(*scenario, folder.string(), {});
  scenario->simulation->run(4);
  recording->finish();
  auto const table = read_csv((folder / "diagnoses.csv").string());
  // 2 particles of 40 amu at 1 nm/ps: 40 amu nm^2/ps^2, each 1e-24 J / 4184 * 6.02214076e23.
  EXPECT_NEAR(table.column("kinetic energy (kcal/mol)").front(), 40 * 1.66053906660e-27 * 1e6 * 6.02214076e23 / 4184,
              1e-6);
  EXPECT_NEAR(table.column("time (fs)").back(), 4, 1e-9);
  TrajectoryReader const reader((folder / "trajectory.h5").string());
  EXPECT_NEAR(reader.read(0, "atoms", "position", TrajectoryReader::Numbers::written)[3], 20, 1e-12);
  EXPECT_NEAR(reader.read(0, "atoms", "velocity", TrajectoryReader::Numbers::written)[0], 10, 1e-12);
  EXPECT_NEAR(reader.read(0, "atoms", "position")[3], 2, 1e-12);
  // What is stored says it, too.
  EXPECT_EQ(parse_scenario(scenario->resolved, "again.toml")->units.display(dimensions::energy).unit, "kcal/mol");
  std::filesystem::remove_all(folder);
}

TEST(OutputUnits, MistakesAreToldInOneLine) {
  auto const told = [](std::string const& units) {
    return message([&] { parse_scenario(scenario_of(units), "u.toml"); });
  };
  EXPECT_NE(told("units = { energy = \"kg\" }\n").find("energy: 'kg' is a mass, an energy is needed (e.g. 'J', 'eV')"),
            std::string::npos)
      << told("units = { energy = \"kg\" }\n");
  EXPECT_NE(told("units = { enrgy = \"eV\" }\n").find("did you mean 'energy'?"), std::string::npos);
  EXPECT_NE(told("units = { energy = \"kcl/mol\" }\n").find("did you mean"), std::string::npos);
  EXPECT_NE(told("units = \"metal\"\n").find("units: a table is needed"), std::string::npos);
  EXPECT_NE(message([] {
              parse_scenario(scenario_of("units = { energy = \"eV\" }\n", "base = \"reduced\"\n"), "u.toml");
            }).find("pure numbers"),
            std::string::npos);
}

// Units of atoms are for atoms, and a galaxy moves by kilometres a second.
TEST(OutputUnits, FollowTheBase) {
  using namespace dimensions;
  UnitSystem const galaxy(1e3 * units::parsec, 1e9 * units::solar_mass, 1e6 * units::year);
  EXPECT_EQ(galaxy.display(velocity).unit, "km/s");
  EXPECT_NEAR(galaxy.display(velocity).factor / 977.8, 1, 1e-3);
  UnitSystem const slow(1 * units::meter, 1 * units::kilogram, 0.01 * units::second);  // 100 m/s, which is angstrom/ps
  EXPECT_EQ(slow.display(velocity).unit, "m/s");
  EXPECT_EQ(UnitSystem(1 * units::angstrom, 1 * units::amu, 1 * units::picosecond).display(velocity).unit,
            "angstrom/ps");
}

}  // namespace
}  // namespace boltzmann::output_units_test
