// A class of three fields that a scenario derives beside the same class compiled, in turns: whole steps of a liquid of
// 32,000 atoms by leap-frog, and of the fields alone by rk4. CPU time of one thread, medians.
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>

#include "timing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

namespace {

using namespace boltzmann;

template <int D, class Real = double>
struct Grain : Newton<D, Real> {
  static constexpr char const* class_name = "Grain";
  static constexpr bool velocity_dependent = true;  // so that leap-frog predicts: second order, as that of the scenario

  Real charge, heat, way;

  static void equations(auto const& p, auto const& force, auto const& rate) {
    Newton<D, Real>::equations(p, force, rate);
    rate(&Grain::charge, (3.0 - p.charge) * (1 / 0.7));
    rate(&Grain::heat, p.charge * p.charge - 0.1 * p.heat);
    rate(&Grain::way, dot(p.velocity, p.velocity));
  }

  static FieldTable fields() {
    return Newton<D, Real>::fields()
        .add(&Grain::charge, "charge", dimensions::none, "")
        .add(&Grain::heat, "heat", dimensions::none, "")
        .add(&Grain::way, "way", dimensions::none, "");
  }
};

std::string scenario(bool liquid) {
  LatticeBlock const block{Lattice::fcc, spacing_for_density(Lattice::fcc, 3, 0.8442), {20, 20, 20}};
  std::string const edge = fmt::format("{}", repeat_lengths(block, 3)[0]);
  return "[units]\nbase = \"reduced\"\n[box]\nlow = [0, 0, 0]\nhigh = [" + edge + ", " + edge + ", " + edge +
         "]\nboundary = \"periodic\"\n[run]\nstep = 0.002\nsteps = 1\ncutoff = 2.5\nskin = 0.3\nthreads = 1\n"
         "[[classes]]\nname = \"Grain\"\nbase = \"Newton\"\nfields = [{ name = \"charge\" }, { name = \"heat\" }, { "
         "name = "
         "\"way\" }]\nrate.charge = \"(3 - charge)/0.7\"\nrate.heat = \"charge^2 - 0.1*heat\"\n"
         "rate.way = \"dot(velocity, velocity)\"\n[[ensembles]]\nname = \"atoms\"\nclass = \"Grain\"\nmass = "
         "1\nintegrator = \"" +
         (liquid ? "leap-frog" : "rk4") +
         "\"\nload = { kind = \"block\", lattice = \"fcc\", counts = [20, 20, 20], spacing = " +
         fmt::format("{}", block.spacing) + " }\ntemperature = 1.44\n" +
         (liquid ? "[[influences]]\nlaw = \"lennard-jones\"\ndepth = 1\nr0 = 1.122462048309373\non = \"atoms\"\n" : "");
}

void compare(char const* name, bool liquid, std::uint64_t steps) {
  auto const typed = parse_scenario(scenario(liquid), "grains.toml");
  AnyEnsemble const& theirs = *typed->ensembles[0];
  Ensemble<Grain<3>> atoms("atoms", theirs.size());
  for (std::size_t i = 0; i < atoms.size(); ++i) std::copy_n(theirs.row(i), theirs.doubles(), atoms.row(i));
  PairScheme scheme(typed->schemes[0]->box(), 2.5);
  scheme.skin(0.3);
  scheme.threads(1);
  if (liquid)
    scheme.internal(atoms, LennardJones{.depth = 1, .r0 = std::pow(2.0, 1.0 / 6)});
  else
    scheme.add(atoms);
  Simulation compiled(scheme, 0.002);
  compiled.integrate(atoms, liquid ? Method::leap_frog : Method::rk4);
  compiled.run(20), typed->simulation->run(20);
  double off = 0;
  for (std::size_t i = 0; i < atoms.size(); ++i)
    for (char const* field : {"charge", "heat", "way"})
      off =
          std::max(off, std::fabs(theirs.row(i)[theirs.field(field).offset] - atoms.row(i)[atoms.field(field).offset]));
  std::vector<double> ratios;
  for (int turn = 0; turn < 15; ++turn) {
    double const start = cpu_seconds();
    compiled.run(steps);
    double const middle = cpu_seconds();
    typed->simulation->run(steps);
    ratios.push_back((cpu_seconds() - middle) / (middle - start));
  }
  std::printf("%-28s %3.0f %% of the compiled class's time; fields differ by %.1e\n", name, 100 * median(ratios), off);
}

}  // namespace

int main() {
  compare("a liquid, leap-frog", true, 20);
  compare("fields alone, rk4", false, 20);
}
