// What laws cost in a neighbour list, as ratios to Lennard-Jones: by energy, from a table, with exp, with fields beyond
// the first row block, of a mixture. Each is timed in turns with Lennard-Jones on the same melt.
#include <boltzmann/boltzmann.hpp>

#include "timing.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace {

using namespace boltzmann;

/// The melt of benchmarks/lennard_jones.cpp, shaken, with one law.
template <class P>
struct Melt {
  Ensemble<P> atoms{"atoms"};
  std::unique_ptr<PairScheme> scheme;

  template <class Law>
  explicit Melt(Law const& law) {
    LatticeBlock const block{Lattice::fcc, spacing_for_density(Lattice::fcc, 3, 0.8442), {16, 16, 16}};
    block_load(atoms, block);
    maxwellian_load(atoms, {.temperature = 1.44});
    for (std::size_t i = 0; i < atoms.size(); ++i) {
      atoms[i].position += 0.06 * atoms[i].velocity;
      if constexpr (requires { atoms[i].charge; }) atoms[i].charge = i % 2 == 0 ? 1 : -1;
      if constexpr (requires { atoms[i].species; }) atoms[i].species = static_cast<double>(i % 2);
    }
    auto const length = repeat_lengths(block, 3);
    scheme = std::make_unique<PairScheme>(
        Box(Vector{0.0, 0.0, 0.0}, Vector{length[0], length[1], length[2]}, Boundary::periodic), 2.5);
    scheme->skin(0.3);
    scheme->threads(1);
    scheme->internal(atoms, law);
    scheme->calculate();
  }
  double seconds() {
    scheme->calculate();  // not timed: whoever ran before has driven this melt out of the caches
    double const since = cpu_seconds();
    for (int n = 0; n < 10; ++n) scheme->calculate();
    return (cpu_seconds() - since) / 10;
  }
};

struct Contestant {
  std::string name;
  std::function<double()> seconds;
};

template <class P, class Law>
Contestant contestant(std::string name, Law const& law) {
  auto melt = std::make_shared<Melt<P>>(law);
  return {std::move(name), [melt] { return melt->seconds(); }};
}

}  // namespace

int main() {
  double const r0 = std::pow(2.0, 1.0 / 6);
  LennardJones const lennard_jones{.depth = 1, .r0 = r0};
  auto const energy = [=](auto const& p, auto const& q) {
    auto const r = q.position - p.position;
    auto const s6 = cube(r0 * r0 / dot(r, r));
    return s6 * (s6 - 2.0);
  };
  auto const morse_energy = [=](auto const& p, auto const& q) {
    auto const e = exp(-6.0 / r0 * (magnitude(q.position - p.position) - r0));
    return e * (e - 2.0);
  };
  auto const yukawa = [](auto const& p, auto const& q) {
    auto const r = q.position - p.position;
    auto const distance = sqrt(dot(r, r));
    auto const inverse = 1.0 / distance;
    auto const u = 5.0 * inverse * exp(-distance);
    return Interaction{r * (-u * inverse * (inverse + 1.0)), u};
  };
  auto const charged = [=](auto const& p, auto const& q) {  // and a bare Coulomb force
    auto const r = q.position - p.position;
    auto const inverse2 = 1.0 / dot(r, r);
    auto const s6 = cube(r0 * r0 * inverse2);
    auto const c = p.charge * q.charge * inverse2;
    return Interaction{r * ((-12.0 * s6 * (s6 - 1.0) - c) * inverse2), s6 * (s6 - 2.0)};
  };

  auto const at_distance = [](double r) { return std::pow(r, -6) * (std::pow(r, -6) - 2); };
  Table const table([=](double r) { return at_distance(r / r0); }, 0.6, 2.5, Tolerance{1e-5});
  Table const fine_table([=](double r) { return at_distance(r / r0); }, 0.6, 2.5, Tolerance{1e-6});
  std::printf("tables: %zu intervals (error %.1e), %zu intervals (error %.1e)\n", table.intervals(),
              table.error().relative, fine_table.intervals(), fine_table.error().relative);

  LennardJonesMixture const two(std::array{lennard_jones, LennardJones{.depth = 0.5, .r0 = 0.9 * r0}});
  LennardJonesMixture const four(std::array{lennard_jones, two.between(1, 1), lennard_jones, lennard_jones});
  LennardJonesMixture const eight(std::array{lennard_jones, two.between(1, 1), lennard_jones, lennard_jones,
                                             lennard_jones, lennard_jones, lennard_jones, lennard_jones});

  auto reference = contestant<Newton<3>>("lennard-jones", lennard_jones);
  std::vector<Contestant> const contestants{
      contestant<Newton<3>>("lennard-jones again", lennard_jones),
      contestant<Newton<3>>("lennard-jones by energy", by_energy(energy)),
      contestant<Newton<3>>("a table", table),
      contestant<Newton<3>>("a finer table", fine_table),
      contestant<Newton<3>>("morse", Morse{.depth = 1, .r0 = r0, .a = 6 / r0}),
      contestant<Newton<3>>("morse by energy", by_energy(morse_energy)),
      contestant<Newton<3>>("yukawa (a lambda)", antisymmetric(yukawa)),
      contestant<Coulomb<3>>("lennard-jones, rows with a charge", lennard_jones),
      contestant<Coulomb<3>>("a law that reads the charge", antisymmetric(charged)),
      contestant<Species<3>>("a mixture of 2 species", two),
      contestant<Species<3>>("a mixture of 4 species", four),
      contestant<Species<3>>("a mixture of 8 species", eight),
  };
  for (auto const& one : contestants) {
    std::vector<double> ratios;
    double least = 1e9;
    for (int n = 0; n < 5; ++n) {
      double const before = reference.seconds(), here = one.seconds(), after = reference.seconds();
      ratios.push_back(2 * here / (before + after));
      least = std::min(least, here);
    }
    std::sort(ratios.begin(), ratios.end());
    std::printf("%-36s %6.2f times Lennard-Jones (%.2f to %.2f), %6.2f ms\n", one.name.c_str(), ratios[2], ratios[0],
                ratios[4], least * 1e3);
  }
}
