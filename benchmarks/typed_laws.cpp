// Typed laws beside the same ones compiled, in turns: passes over the lists of a liquid of 32,000 atoms, and whole steps of
// its Lennard-Jones run; and how long it takes from a text to the first step. CPU time of one thread, medians.
#include <boltzmann/boltzmann.hpp>
#include <boltzmann/scenario/scenario.hpp>

#include "timing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace {

using namespace boltzmann;

/// M atom-steps/s of OpenMM 7.7 with Lennard-Jones typed as a CustomNonbondedForce (CPU platform, single precision).
constexpr double openmm_custom_force = 0.32;

/// A liquid of charged atoms and its scheme.
struct Liquid {
  Ensemble<Coulomb<3>> atoms{"atoms"};
  std::unique_ptr<PairScheme> scheme;

  template <class Law>
  explicit Liquid(Law const& law) {
    LatticeBlock const block{Lattice::fcc, spacing_for_density(Lattice::fcc, 3, 0.8442), {20, 20, 20}};
    block_load(atoms, block);
    maxwellian_load(atoms, {.temperature = 1.44});
    for (std::size_t i = 0; i < atoms.size(); ++i) {
      atoms[i].charge = i % 2 == 0 ? 1 : -1;
      atoms[i].position += 0.05 * atoms[i].velocity;  // off their sites, where all influences are zero
    }
    auto const length = repeat_lengths(block, 3);
    scheme = std::make_unique<PairScheme>(
        Box(Vector{0.0, 0.0, 0.0}, Vector{length[0], length[1], length[2]}, Boundary::periodic), 2.5);
    scheme->skin(0.3);
    scheme->threads(1);
    scheme->internal(atoms, law);
  }
};

template <class Law>
void compare(char const* name, Law const& compiled, FormulaLaw const& typed, bool with_steps) {
  Liquid a(compiled), b(typed);
  Simulation one(*a.scheme, 0.002), other(*b.scheme, 0.002);
  if (with_steps) one.run(50), other.run(50);  // a melt
  a.scheme->calculate(), b.scheme->calculate();
  double largest = 0, off = 0;
  if (!with_steps)
    for (std::size_t i = 0; i < a.atoms.size(); ++i)
      for (int c = 0; c < 3; ++c) {
        largest = std::max(largest, std::fabs(a.atoms.influence(i)[c]));
        off = std::max(off, std::fabs(a.atoms.influence(i)[c] - b.atoms.influence(i)[c]));
      }
  std::vector<double> passes, steps, typed_steps;
  for (int turn = 0; turn < 21; ++turn) {
    double const start = cpu_seconds();
    a.scheme->calculate();
    double const middle = cpu_seconds();
    b.scheme->calculate();
    passes.push_back((middle - start) / (cpu_seconds() - middle));
  }
  std::printf("%-42s pass: %3.0f %% of the compiled law's speed", name, 100 * median(passes));
  if (with_steps) {
    for (int turn = 0; turn < 9; ++turn) {
      double const start = cpu_seconds();
      one.run(20);
      double const middle = cpu_seconds();
      other.run(20);
      double const end = cpu_seconds();
      steps.push_back((middle - start) / (end - middle));
      typed_steps.push_back((end - middle) / 20);
    }
    std::printf(", whole steps: %3.0f %%\n", 100 * median(steps));
    std::printf(
        "%-42s %.2f M atom-steps/s, typed; OpenMM's custom force, the same liquid on one core of another machine: "
        "%.2f\n",
        "", 1e-6 * static_cast<double>(b.atoms.size()) / median(typed_steps), openmm_custom_force);
  } else {
    std::printf(", influences differ by %.1e of the largest\n", largest > 0 ? off / largest : 0);
  }
}

/// From the text of a scenario of 500 atoms with a typed law to the end of the first step.
void start() {
  std::string const text =
      "[units]\nbase = \"reduced\"\n[box]\nlow = [0, 0, 0]\nhigh = [8.4, 8.4, 8.4]\nboundary = "
      "\"periodic\"\n[run]\nstep "
      "= 0.002\nsteps = 1\ncutoff = 2.5\nthreads = 1\n[[ensembles]]\nname = \"atoms\"\nclass = \"Newton\"\nmass = "
      "1\ntemperature = 1\nload = { kind = \"block\", lattice = \"fcc\", counts = [5, 5, 5], spacing = 1.18793 "
      "}\n[[influences]]\nenergy = \"4*depth*(s^2 - s)\"\nwhere = { s = \"(sigma/r)^6\" }\nparameters = { depth = 1, "
      "sigma "
      "= 1 }\non = \"atoms\"\n";
  std::vector<double> times;
  for (int turn = 0; turn < 21; ++turn)
    times.push_back(cpu_seconds([&] { parse_scenario(text, "atoms.toml")->simulation->run(1); }));
  std::printf("from the text of a scenario to its first step %.1f ms, the first time %.1f ms\n", 1e3 * median(times),
              1e3 * times.front());
}

}  // namespace

int main() {
  start();
  double const r0 = std::pow(2.0, 1.0 / 6);
  auto const lennard_jones = FormulaLaw::energy("depth*((r0/r)^12 - 2*(r0/r)^6)", {{"depth", 1}, {"r0", r0}});
  compare("lennard-jones", LennardJones{.depth = 1, .r0 = r0}, lennard_jones, true);
  compare("morse", Morse{.depth = 1, .r0 = r0, .a = 5},
          FormulaLaw::energy("depth*((1 - exp(-a*(r - r0)))^2 - 1)", {{"depth", 1}, {"r0", r0}, {"a", 5}}), false);
  compare("charges behind a screen (by_energy)", by_energy([](auto const& p, auto const& q) {
            auto const r = magnitude(q.position - p.position);
            return p.charge * q.charge * exp(-1.0 * r) / r;
          }),
          FormulaLaw::energy("p.charge*q.charge*exp(-r/1)/r"), false);
  compare(
      "friction along the line of centres",
      [](auto const& p, auto const& q) {
        auto const d = q.position - p.position;
        auto const square = dot(d, d);
        auto const w = 1.0 - sqrt(square) * (1 / 2.5);
        return d * (3.0 * w * w * dot(d, q.velocity - p.velocity) / square);
      },
      FormulaLaw::influence("3*(1 - r/2.5)^2*dot(separation, velocity)*separation/r^2"), false);
}
