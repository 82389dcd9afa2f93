// Kind of fault: grounded walls of a mesh missed half a cell of charge. Here what a user sees: field and density at the
// plates in the files of a run, for each assignment, form and pair of ends, in 1D to 3D, charges and gravity.
// tests/schemes/grounded_walls_test.cpp has the orders of convergence.
#include "tests/cases/case.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

namespace boltzmann::grounded_walls_cases_test {
namespace {

using namespace test;

/// The numbers of an array of the first mesh frame.
std::vector<double> mesh_array(Case const& run, std::string const& name) {
  std::string const file = text_of(run / "run/mesh/000000000.vti");
  std::size_t const tag = file.find("Name=\"" + name + "\"");
  std::size_t const offset = file.find("offset=\"", tag);
  if (tag == std::string::npos || offset == std::string::npos) return {};
  char const* data = file.data() + file.find('_', file.find("<AppendedData")) + 1 + std::stoul(file.substr(offset + 8));
  std::uint64_t size = 0;
  std::memcpy(&size, data, sizeof size);
  std::vector<double> numbers(size / sizeof(double));
  std::memcpy(numbers.data(), data + sizeof size, size);
  return numbers;
}

std::string replaced(std::string text, std::string const& from, std::string const& to) {
  text.replace(text.find(from), from.size(), to);
  return text;
}

double const exact_field = 9.0476e6, exact_density = 1.602176634e-3;

}  // namespace

TEST(GroundedWallsOfScenarios, TheReport) {
  Case const run("grounded-plates");
  auto const outcome = run.run();
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  auto const field = mesh_array(run, "field"), density = mesh_array(run, "density");
  ASSERT_EQ(density.size(), 101U);
  EXPECT_NEAR(field.front(), -exact_field, 1e-4 * exact_field);
  EXPECT_NEAR(field[300], exact_field, 1e-4 * exact_field);
  for (double const rho : density) EXPECT_NEAR(rho, exact_density, 1e-4 * exact_density);
}

TEST(GroundedWallsOfScenarios, EachAssignmentFormAndEnd) {
  std::string const text = text_of(fs::path(BOLTZMANN_SOURCE) / "tests/cases/files/grounded-plates.toml");
  for (std::string const assignment : {"ngp", "cic", "tsc"})
    for (std::string const poisson : {"finite-difference", "spectral"})
      for (std::string const ends : {"\"dirichlet\"", "[\"neumann\", \"dirichlet\"]", "[\"dirichlet\", \"neumann\"]"}) {
        Case const run("plates", replaced(replaced(text, "cells = 100\nboundary = [\"dirichlet\"]",
                                                   fmt::format("cells = 20\nboundary = [{}]\nassignment = \"{}\"\n"
                                                               "poisson = \"{}\"",
                                                               ends, assignment, poisson)),
                                          "law = \"coulomb\"", "law = \"coulomb\""));
        auto const outcome = run.run({"--quiet"});
        ASSERT_EQ(outcome.status, 0) << outcome.err;
        auto const field = mesh_array(run, "field"), density = mesh_array(run, "density");
        ASSERT_EQ(density.size(), 21U);
        for (double const rho : density) EXPECT_NEAR(rho, exact_density, 1e-3 * exact_density) << assignment << ends;
        bool const both = ends.size() < 14;
        // With one insulated end all field lines go to the other plate.
        double const at_plate = both ? exact_field : 2 * exact_field;
        bool const low = ends.find("dirichlet") < 4;
        EXPECT_NEAR(low ? -field.front() : field[60], at_plate, 2e-3 * at_plate) << assignment << poisson << ends;
      }
}

TEST(GroundedWallsOfScenarios, TwoAndThreeDimensions) {
  for (int const dimension : {2, 3})
    for (bool const gravity : {false, true}) {
      Case const run("box", fmt::format(R"(
[units]
base = "reduced"
[box]
low = [0, 0{0}]
high = [2, 1{1}]
boundary = ["reflecting", "periodic"{2}]
[run]
step = 0.001
steps = 0
[mesh]
law = "{3}"
{4} = 1
cells = [16, 8{5}]
boundary = ["dirichlet", "periodic"{6}]
[[ensembles]]
name = "matter"
class = "{7}"
number = {8}
mass = 1
{9}
load = {{ kind = "fill" }}
[[diagnoses]]
kind = "field-energy"
[output]
diagnoses = 1
mesh = 1
)",
                                        dimension == 3 ? ", 0" : "", dimension == 3 ? ", 1" : "",
                                        dimension == 3 ? ", \"periodic\"" : "", gravity ? "gravity" : "coulomb",
                                        gravity ? "G" : "k", dimension == 3 ? ", 8" : "",
                                        dimension == 3 ? ", \"periodic\"" : "", gravity ? "Kepler" : "Coulomb",
                                        dimension == 3 ? 8192 : 8192, gravity ? "" : "charge = 1"));
      auto const outcome = run.run({"--quiet"});
      ASSERT_EQ(outcome.status, 0) << outcome.err;
      auto const field = mesh_array(run, "field"), density = mesh_array(run, "density");
      double const pi = 3.14159265358979, n = 8192 / 2.0;
      double const C = (gravity ? -1 : 1) * (dimension == 2 ? 2 : 4) * pi * (dimension == 2 ? 1 : 1);
      double const exact = C * n * 1.0;  // C n L / 2
      ASSERT_FALSE(density.empty());
      for (double const rho : density) EXPECT_NEAR(rho, n, 0.02 * n);
      double const expected = dimension == 2 ? 2 * exact : exact;  // div E = 4 pi k rho in every dimension
      EXPECT_NEAR(field.front(), -expected, 0.01 * std::abs(expected)) << dimension << outcome.err;
    }
}

}  // namespace boltzmann::grounded_walls_cases_test
