// Mesoparticles: particle steps per second of crystalline PVDF (DPDE, 2D) by every method, of a DPD fluid in 3D, and of
// the same crystal by hand in the same run. Numbers of particles as arguments; without, 1600 100000 1000000.
#include <boltzmann/boltzmann.hpp>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

extern "C" std::size_t meso_by_hand(std::size_t n, double const* model, double lx, double ly, double* x, double* v,
                                    double* energy, double dt, unsigned first_step, unsigned steps);

namespace {

using namespace boltzmann;

double seconds(std::chrono::steady_clock::time_point since) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
}

/// The largest memory that this process has had, in bytes.
double peak() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == "VmHWM:") {
      double kilobytes = 0;
      status >> kilobytes;
      return 1024 * kilobytes;
    }
  return 0;
}

/// Another dissipation, and how long it has worked.
class Timed final : public Dissipation {
 public:
  explicit Timed(Dissipation& dpd) : dpd_(dpd) {}
  std::vector<AnyEnsemble*> ensembles() const override { return dpd_.ensembles(); }
  void check() override { dpd_.check(); }
  void advance(StepContext const& context) override {
    dpd_.threads(threads());
    auto const since = std::chrono::steady_clock::now();
    dpd_.advance(context);
    spent += seconds(since);
  }

  double spent = 0;

 private:
  Dissipation& dpd_;
};

struct Speed {
  double rate, share;
  double temperature;  // kinetic, at the end
};

template <class P>
double kinetic_temperature(Ensemble<P> const& ensemble, double k) {
  double sum = 0;
  for (std::size_t i = 0; i < ensemble.size(); ++i) sum += ensemble[i].mass * norm2(ensemble[i].velocity);
  return sum / (k * P::dimension * static_cast<double>(ensemble.size()));
}

/// So many steps, a quarter as many first.
template <class P>
Speed measure(PairScheme& scheme, Ensemble<P>& ensemble, Dissipation& dpd, double dt, double k, int threads,
              unsigned steps) {
  Timed timed(dpd);
  Simulation simulation(scheme, dt);
  simulation.add(timed);
  simulation.integrate(ensemble, Method::leap_frog);
  simulation.threads(threads);
  simulation.run(steps / 4 + 1);
  timed.spent = 0;
  auto const since = std::chrono::steady_clock::now();
  simulation.run(steps);
  double const whole = seconds(since);
  return {static_cast<double>(ensemble.size()) * steps / whole, timed.spent / whole, kinetic_temperature(ensemble, k)};
}

void print(std::size_t size, std::string const& what, Speed const& one, Speed const& two) {
  std::printf("%8zu  %-28s %6.2f million particle steps/s, friction %2.0f %% of the time; 2 threads: x %.2f\n", size,
              what.c_str(), one.rate * 1e-6, 100 * one.share, two.rate / one.rate);
  std::fflush(stdout);
}

// angstrom, picosecond, amu, kelvin.
constexpr double amu = 1.66053907e-27, k = 0.831446;
constexpr double spacing = 5.13, range = 15, mass = 64.03, temperature = 300, capacity = 16 * k, dt = 0.005;
constexpr double depth = 1.612e-20 / amu * 1e-4, friction = 1.5e-14 / amu * 1e-12;
constexpr Rydberg rydberg{.depth = depth, .r0 = 5.07, .a = 7.90, .alpha = 0.185};

struct Crystal {
  Ensemble<Meso<2>> beads{"pvdf"};
  std::array<double, 3> length;
  PairScheme scheme;
  PairDissipation dpd;

  explicit Crystal(LatticeBlock const& block)
      : length(repeat_lengths(block, 2)),
        scheme(Box(Vector{0.0, 0.0}, Vector{length[0], length[1]}, Boundary::periodic), range),
        dpd(scheme, k) {
    block_load(beads, block);
    for (auto& p : beads) p.mass = mass;
    maxwellian_load(beads, {.temperature = 2 * temperature,
                            .boltzmann_constant = k,
                            .remove_drift = true});  // half of it goes into the bonds
    internal_energy_load(beads, StateLaw(capacity), {.temperature = temperature, .boltzmann_constant = k});
    scheme.internal(beads, rydberg);
    dpd.state(beads, StateLaw(capacity));
    DissipationLaw d;
    d.friction = friction;
    d.range = range;
    d.exponent = 2;
    d.projected = false;
    dpd.internal(beads, d);
  }
};

LatticeBlock block_of(std::size_t particles) {
  auto const columns = static_cast<std::size_t>(std::lround(std::sqrt(1.6 * static_cast<double>(particles)) / 2)) * 2;
  auto const rows =
      static_cast<std::size_t>(std::lround(static_cast<double>(particles) / static_cast<double>(columns) / 2)) * 2;
  return {Lattice::triangular, spacing, {columns, rows, 1}, {0.1, 0.1, 0}};
}

/// The crystal by one method, with one thread and with two.
Speed crystal(std::string const& what, std::size_t particles, unsigned steps,
              std::function<void(PairDissipation&)> const& set) {
  Speed speed[2];
  std::size_t size = 0;
  for (int const threads : {1, 2}) {
    Crystal crystal(block_of(particles));
    set(crystal.dpd);
    size = crystal.beads.size();
    speed[threads - 1] = measure(crystal.scheme, crystal.beads, crystal.dpd, dt, k, threads, steps);
  }
  print(size, what, speed[0], speed[1]);
  return speed[0];
}

/// The same by hand, one thread.
Speed by_hand(std::size_t particles, unsigned steps) {
  Crystal crystal(block_of(particles));
  std::vector<double> x, v, energy;
  for (auto const& p : crystal.beads) {
    for (int a = 0; a < 2; ++a) x.push_back(p.position[a]), v.push_back(p.velocity[a]);
    energy.push_back(p.internal_energy);
  }
  double const model[] = {mass, depth, 5.07, 7.90, 0.185, range, crystal.scheme.skin(), friction, capacity};
  auto const run = [&](unsigned first, unsigned count) {
    return meso_by_hand(energy.size(), model, crystal.length[0], crystal.length[1], x.data(), v.data(), energy.data(),
                        dt, first, count);
  };
  run(0, steps / 4 + 1);
  auto const since = std::chrono::steady_clock::now();
  run(steps / 4 + 1, steps);
  double const rate = static_cast<double>(energy.size()) * steps / seconds(since);
  double sum = 0;
  for (double const u : v) sum += mass * u * u;
  std::printf("%8zu  %-28s %6.2f million particle steps/s\n", energy.size(), "simultaneous by hand", rate * 1e-6);
  return {rate, 0, sum / (2 * k * static_cast<double>(energy.size()))};
}

/// Groot and Warren's fluid: density 3, repulsion 25, friction 4.5, projected.
void fluid(std::size_t edge, unsigned steps) {
  double const length = static_cast<double>(edge);
  Speed speed[2];
  std::size_t const size = 3 * edge * edge * edge;
  for (int const threads : {1, 2}) {
    Ensemble<Newton<3>> beads("fluid", size);
    for (std::size_t i = 0; i < size; ++i) {
      Stream stream(1, 0, i, Purpose::position);
      for (int a = 0; a < 3; ++a) beads[i].position[a] = length * stream.uniform();
    }
    maxwellian_load(beads, {.temperature = 1, .remove_drift = true});
    PairScheme scheme(Box(Vector{0.0, 0.0, 0.0}, Vector{length, length, length}, Boundary::periodic), 1);
    scheme.internal(beads, Soft{.repulsion = 25, .range = 1});
    PairDissipation dpd(scheme, 1);
    DissipationLaw d;
    d.convention = Convention::fixed_temperature;
    d.friction = 4.5;
    d.temperature = 1;
    d.range = 1;
    dpd.internal(beads, d);
    Simulation settle(scheme, 0.01);
    settle.add(dpd);
    settle.integrate(beads, Method::leap_frog);
    settle.run(30);
    speed[threads - 1] = measure(scheme, beads, dpd, 0.04, 1, threads, steps);
  }
  print(size, "DPD fluid 3D, simultaneous", speed[0], speed[1]);
}

}  // namespace

int main(int argc, char** argv) try {
  std::vector<std::size_t> sizes;
  for (int n = 1; n < argc; ++n) sizes.push_back(std::strtoul(argv[n], nullptr, 10));
  if (sizes.empty()) sizes = {1600, 100000, 1000000};
  std::printf("PVDF, 2D: lattice of 5.13 angstrom at 300 K, range 15 angstrom, 5 fs\n");
  for (std::size_t const size : sizes) {
    // About a second of a core each.
    auto const steps = static_cast<unsigned>(std::max(4.0, 4e6 / static_cast<double>(size)));
    Speed const ours = crystal("simultaneous", size, steps, [](auto&) {});
    if (size > 300000) {
      double const bytes = peak();
      std::printf("          peak memory %.2f GB, %.0f bytes a particle\n", bytes * 1e-9,
                  bytes / static_cast<double>(size));
      continue;
    }
    crystal("simultaneous with corrector", size, steps, [](auto& dpd) { dpd.corrector(true); });
    crystal("shardlow", size, steps, [](auto& dpd) { dpd.method(DissipationMethod::shardlow); });
    crystal("shardlow, metropolis", size, steps, [](auto& dpd) {
      dpd.method(DissipationMethod::shardlow);
      dpd.metropolis(true);
    });
    Speed const theirs = by_hand(size, steps);
    std::printf("          simultaneous: %.1f times as fast as by hand (%.1f K and, by hand, %.1f K at the end)\n",
                ours.rate / theirs.rate, ours.temperature, theirs.temperature);
  }
  fluid(30, 20);
  return 0;
} catch (std::exception const& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
