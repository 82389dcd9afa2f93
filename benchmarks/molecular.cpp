// One molecular-dynamics problem as `peers` runs it with every code: which, how large, how many steps, how many
// threads.
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/schemes/mesh/p3m_scheme.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <string>
#include <vector>

namespace {

using namespace boltzmann;

/// All in units of the law: depth 1, sigma 1, mass 1; dt and skin as given.
struct Run {
  LatticeBlock block;
  double temperature, cutoff, skin, dt, knock_on_energy;
  std::uint64_t warm_up, steps;
  int threads;
};

/// Prints the energies before and after and the rate of the steps.
template <class P, class S>
void time_steps(Run const& r, S& scheme, Ensemble<P>& atoms) {
  double const start = scheme.measure().potential / static_cast<double>(atoms.size());
  Simulation simulation(scheme, r.dt);
  simulation.integrate(atoms, Method::leap_frog);
  simulation.run(r.warm_up);
  auto const since = std::chrono::steady_clock::now();
  simulation.run(r.steps);
  double const seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
  double const end = scheme.measure().potential / static_cast<double>(atoms.size());
  std::printf("particles %zu steps %llu threads %d seconds %.6f rate %.6g start %.10f end %.6f %s\n", atoms.size(),
              static_cast<unsigned long long>(r.steps), r.threads, seconds,
              static_cast<double>(atoms.size() * r.steps) / seconds, start, end, scheme.report().c_str());
}

template <int D>
void run(Run const& r) {
  Ensemble<Newton<D>> atoms("atoms");
  block_load(atoms, r.block, true);
  for (auto& atom : atoms) atom.mass = 1;
  maxwellian_load(atoms, r.temperature, 1, 1, {.remove_drift = true, .exact_temperature = true});
  if (r.knock_on_energy > 0) {
    double const speed = std::sqrt(2 * r.knock_on_energy), angle = std::atan2(-0.45, 0.4);
    atoms[atoms.size() / 2].velocity[0] = speed * std::cos(angle);
    atoms[atoms.size() / 2].velocity[1] = speed * std::sin(angle);
  }
  auto const length = repeat_lengths(r.block, D);
  Vector<D> low{}, high{};
  for (int a = 0; a < D; ++a) high[a] = length[a];
  PairScheme scheme(Box(low, high, Boundary::periodic), r.cutoff);
  scheme.skin(r.skin);
  scheme.shifted(false);
  scheme.threads(r.threads);
  scheme.internal(atoms, LennardJones{.depth = 1, .r0 = std::pow(2.0, 1.0 / 6)});
  time_steps(r, scheme, atoms);
}

// ---- ions: the melt with charges +1 and -1 ----

LatticeBlock melt_block(std::size_t cells) {
  return {Lattice::fcc, spacing_for_density(Lattice::fcc, 3, 0.8442), {cells, cells, cells}};
}
LennardJones const of_ions{.depth = 1, .r0 = std::pow(2.0, 1.0 / 6)};
constexpr double cutoff_of_ions = 2.5;

/// The melt after 400 steps without charges, every second atom then positive, the others negative, as LAMMPS reads it.
void write_ions(std::size_t cells, char const* path) {
  LatticeBlock const block = melt_block(cells);
  Ensemble<Newton<3>> atoms("atoms");
  block_load(atoms, block, true);
  for (auto& atom : atoms) atom.mass = 1;
  maxwellian_load(atoms, 1.44, 1, 1, {.remove_drift = true, .exact_temperature = true});
  double const edge = repeat_lengths(block, 3)[0];
  PairScheme scheme(Box(Vector{0.0, 0.0, 0.0}, Vector{edge, edge, edge}, Boundary::periodic), cutoff_of_ions);
  scheme.internal(atoms, of_ions);
  Simulation simulation(scheme, 0.005);
  simulation.integrate(atoms, Method::leap_frog);
  simulation.run(400);

  std::FILE* const file = std::fopen(path, "w");
  if (!file) throw Error(std::string("can't write ") + path);
  std::fprintf(file, "Lennard-Jones ions\n\n%zu atoms\n1 atom types\n", atoms.size());
  for (char const axis : {'x', 'y', 'z'}) std::fprintf(file, "0 %.17g %clo %chi\n", edge, axis, axis);
  std::fprintf(file, "\nMasses\n\n1 1\n\nAtoms\n\n");
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    Vector<3> x = atoms[i].position;
    for (int a = 0; a < 3; ++a) x[a] -= edge * std::floor(x[a] / edge);
    std::fprintf(file, "%zu 1 %d %.17g %.17g %.17g\n", i + 1, i % 2 == 0 ? 1 : -1, x[0], x[1], x[2]);
  }
  std::fprintf(file, "\nVelocities\n\n");
  for (std::size_t i = 0; i < atoms.size(); ++i)
    std::fprintf(file, "%zu %.17g %.17g %.17g\n", i + 1, atoms[i].velocity[0], atoms[i].velocity[1],
                 atoms[i].velocity[2]);
  if (std::fclose(file) != 0) throw Error(std::string("can't write ") + path);
}

struct Ions {
  Ensemble<Coulomb<3>> atoms{"ions"};
  double edge = 0;

  explicit Ions(char const* path) {
    std::ifstream file(path);
    std::string word;
    std::size_t count = 0;
    double low = 0;
    while (file >> word && word != "ions") continue;
    file >> count >> word >> word >> word >> word >> low >> edge;
    atoms.resize(count);
    while (file >> word && word != "Atoms") continue;
    for (std::size_t k = 0, i = 0, type = 0; k < count && file >> i >> type; ++k) {
      auto& atom = atoms[i - 1];
      atom.mass = 1;
      file >> atom.charge >> atom.position[0] >> atom.position[1] >> atom.position[2];
    }
    file >> word;
    for (std::size_t k = 0, i = 0; k < count && file >> i; ++k)
      file >> atoms[i - 1].velocity[0] >> atoms[i - 1].velocity[1] >> atoms[i - 1].velocity[2];
    if (!file || count == 0) throw Error(std::string("can't read ions from ") + path);
  }
  /// Of the charges, and of all.
  std::vector<Vector<3>> forces(double accuracy, bool neutral_too) {
    P3MScheme scheme(Box(Vector{0.0, 0.0, 0.0}, Vector{edge, edge, edge}, Boundary::periodic), coulomb(1), accuracy);
    scheme.load(atoms);
    if (neutral_too) scheme.pairs().internal(atoms, of_ions, cutoff_of_ions);
    scheme.calculate();
    std::vector<Vector<3>> all;
    for (std::size_t i = 0; i < atoms.size(); ++i) all.push_back(atoms.influence_on(i));
    return all;
  }
};

double rms_of(std::vector<Vector<3>> const& forces, std::vector<Vector<3>> const* other = nullptr) {
  double sum = 0;
  for (std::size_t i = 0; i < forces.size(); ++i) sum += norm2(other ? forces[i] - (*other)[i] : forces[i]);
  return std::sqrt(sum / static_cast<double>(forces.size()));
}

/// The errors of our forces at this accuracy, and of those that LAMMPS has dumped (id fx fy fz), in parts of the rms
/// force of the charges.
void compare_forces(char const* path, double accuracy, char const* dump) {
  Ions ions(path);
  double const scale = rms_of(ions.forces(1e-7, false));
  auto const exact = ions.forces(1e-7, true), ours = ions.forces(accuracy, true);
  std::vector<Vector<3>> theirs(exact.size());
  std::ifstream file(dump);
  std::string line;
  while (std::getline(file, line) && line.rfind("ITEM: ATOMS", 0) != 0) continue;
  std::size_t read = 0, i = 0;
  for (Vector<3> f{}; file >> i >> f[0] >> f[1] >> f[2]; ++read) theirs.at(i - 1) = f;
  if (read != exact.size()) throw Error(std::string("can't read forces from ") + dump);
  std::printf("rms force %.6g ours %.4g theirs %.4g\n", scale, rms_of(ours, &exact) / scale,
              rms_of(theirs, &exact) / scale);
}

void run_ions(Run const& r, char const* path, double accuracy) {
  Ions ions(path);
  P3MScheme scheme(Box(Vector{0.0, 0.0, 0.0}, Vector{ions.edge, ions.edge, ions.edge}, Boundary::periodic), coulomb(1),
                   accuracy);
  scheme.threads(r.threads);
  scheme.load(ions.atoms);
  scheme.pairs().skin(r.skin);
  scheme.pairs().shifted(false);
  scheme.pairs().internal(ions.atoms, of_ions, cutoff_of_ions);
  time_steps(r, scheme, ions.atoms);
}

}  // namespace

int main(int argc, char** argv) try {
  std::string const problem = argc > 1 ? argv[1] : "";
  if (argc == 4 && problem == "ions-start") {
    write_ions(std::strtoul(argv[2], nullptr, 10), argv[3]);
    return 0;
  }
  if (argc == 5 && problem == "ions-forces") {
    compare_forces(argv[2], std::atof(argv[3]), argv[4]);
    return 0;
  }
  if (argc != (problem == "ions" ? 8 : 7)) {
    std::fprintf(stderr,
                 "usage: %s melt CELLS WARM_UP STEPS THREADS SKIN, or copper | knock-on COLUMNS ... (rows are 8/5 of "
                 "columns), or ions FILE ... ACCURACY; in units of sigma\n"
                 "       %s ions-start CELLS FILE\n       %s ions-forces FILE ACCURACY DUMP\n",
                 argv[0], argv[0], argv[0]);
    return 2;
  }
  std::size_t const count = std::strtoul(argv[2], nullptr, 10);
  Run r{};
  r.warm_up = std::strtoul(argv[3], nullptr, 10);
  r.steps = std::strtoul(argv[4], nullptr, 10);
  r.threads = std::atoi(argv[5]);
  r.skin = std::atof(argv[6]);
  double const r0 = std::pow(2.0, 1.0 / 6);
  if (problem == "ions") {
    r.dt = 0.005;
    run_ions(r, argv[2], std::atof(argv[7]));
  } else if (problem == "melt") {
    r.block = melt_block(count);
    r.temperature = 1.44;
    r.cutoff = 2.5;
    r.dt = 0.005;
    run<3>(r);
  } else {
    bool const knock_on = problem == "knock-on";
    r.block = {Lattice::triangular, r0, {count, count * 8 / 5, 1}};
    r.temperature = 0.2;
    r.cutoff = 3.01 * r0;  // at 3 r0 itself there is a shell of the lattice
    r.dt = knock_on ? 2e-4 : 0.005;
    r.knock_on_energy = knock_on ? 3600 : 0;
    run<2>(r);
  }
  return 0;
} catch (std::exception const& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
