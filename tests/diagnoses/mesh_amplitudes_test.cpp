// Sums over waves from a mesh: against direct ones within the error that images of the mesh make, and structure factors
// that are known.
#include <boltzmann/core/random.hpp>
#include <boltzmann/diagnoses/mesh_amplitudes.hpp>
#include <boltzmann/diagnoses/structure_factor.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/particles/newton.hpp>

#include <gtest/gtest.h>
#include <tests/diagnoses/look.hpp>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

namespace boltzmann::mesh_amplitudes_test {
namespace {

using Mode = std::array<int, 3>;

using test::look;

template <int D>
Box box_of() {
  Vector<D> low{}, high{};
  for (int a = 0; a < D; ++a) low[a] = -1.0 - a, high[a] = 2.0 + 0.7 * a;
  return Box(low, high, Boundary::periodic);
}

template <int D>
void place_anywhere(Ensemble<Newton<D>>& particles, Box const& box, std::mt19937_64& random) {
  for (auto& p : particles)
    for (int a = 0; a < D; ++a) p.position[a] = std::uniform_real_distribution(box.low(a), box.high(a))(random);
}

std::vector<double const*> rows_of(AnyEnsemble const& ensemble) {
  std::vector<double const*> rows;
  for (std::size_t i = 0; i < ensemble.size(); ++i) rows.push_back(ensemble.row(i));
  return rows;
}

std::vector<Mode> modes_within(Mode const& most) {
  std::vector<Mode> modes;
  for (int x = -most[0]; x <= most[0]; ++x)
    for (int y = -most[1]; y <= most[1]; ++y)
      for (int z = -most[2]; z <= most[2]; ++z) modes.push_back({x, y, z});
  return modes;
}

/// As its definition says.
std::complex<double> direct(AnyEnsemble const& ensemble, Box const& box, Mode const& mode) {
  std::complex<double> sum = 0;
  for (std::size_t i = 0; i < ensemble.size(); ++i) {
    double turns = 0;
    for (int a = 0; a < box.dimension(); ++a)
      turns += mode[static_cast<std::size_t>(a)] * (ensemble.row(i)[a] - box.low(a)) / box.length(a);
    sum += std::polar(1.0, -2 * std::numbers::pi * turns);
  }
  return sum;
}

// Waves up to half of the mesh's Nyquist wave, where 4 n = M, which 4, 6 and 8 periods are on 16, 24 and 32 nodes.
template <int D>
void expect_within_bound(Mode const& most) {
  Box const box = box_of<D>();
  std::mt19937_64 random(test_seed(31 + D));
  Ensemble<Newton<D>> gas("gas", 60);
  place_anywhere(gas, box, random);
  MeshAmplitudes const mesh(rows_of(gas), box, most, 1);
  for (int a = 0; a < D; ++a)
    EXPECT_EQ(mesh.nodes()[static_cast<std::size_t>(a)], 4U * static_cast<unsigned>(most[static_cast<std::size_t>(a)]));
  for (auto const& mode : modes_within(most)) {
    double const error = std::abs(mesh(mode) - direct(gas, box, mode));
    EXPECT_LE(error, 60 * (mesh.bound(mode) + 1e-13)) << D << "D " << mode[0] << ' ' << mode[1] << ' ' << mode[2];
    if (mode == Mode{1, 0, 0}) {
      EXPECT_LT(error, 60 * 2 * std::pow(1.0 / (8 * most[0] - 1), 6) + 1e-11);
    }
  }
  // On a node all images have the same phase: as wrong as can be, not less, so that the bound is none by far.
  Ensemble<Newton<D>> one("one", 1);
  for (int a = 0; a < D; ++a) one[0].position[a] = box.low(a);
  MeshAmplitudes const of_one(rows_of(one), box, most, 1);
  for (auto const& mode : modes_within(most))
    EXPECT_NEAR(std::abs(of_one(mode) - 1.0), of_one.bound(mode), 1e-3 * of_one.bound(mode) + 1e-13);
  EXPECT_NEAR(of_one.bound({most[0], 0, 0}), std::pow(7, -6) + std::pow(9, -6) + std::pow(15, -6) + std::pow(17, -6),
              2e-8);
}

TEST(MeshAmplitudes, AreWrongByImagesOfTheMeshAlone) {
  expect_within_bound<1>({8, 0, 0});
  expect_within_bound<2>({6, 4, 0});
  expect_within_bound<3>({4, 3, 6});
}

TEST(MeshAmplitudes, HaveTheSameBitsForAnyThreadsAndOrder) {
  Box const box = box_of<3>();
  std::mt19937_64 random(test_seed(35));
  Ensemble<Newton<3>> gas("gas", 3000);
  place_anywhere(gas, box, random);
  auto rows = rows_of(gas);
  Mode const most{3, 4, 5};
  MeshAmplitudes const one(rows, box, most, 1), three(rows, box, most, 3);
  std::shuffle(rows.begin(), rows.end(), random);
  MeshAmplitudes const shuffled(rows, box, most, 7);
  for (auto const& mode : modes_within(most)) {
    EXPECT_EQ(one(mode), three(mode));
    EXPECT_EQ(one(mode), shuffled(mode));
    EXPECT_EQ(one(mode), std::conj(one({-mode[0], -mode[1], -mode[2]})));
  }
}

// Of all particles, an ensemble, a group, and between two: S = |rho|^2 / N, and rho is wrong by N times the bound at most.
TEST(MeshAmplitudes, AreNoNumbersWhereAParticleIsNowhere) {
  Box const box = box_of<2>();
  Ensemble<Newton<2>> gas("gas", 3);
  gas[1].position = {0.5, std::nan("")};
  MeshAmplitudes const mesh({gas.row(0), gas.row(1), gas.row(2)}, box, {2, 2, 0}, 1);
  for (Mode const& mode : {Mode{0, 0, 0}, Mode{1, -2, 0}, Mode{0, 2, 0}}) EXPECT_TRUE(std::isnan(mesh(mode).real()));
}

TEST(StructureFactorByMesh, IsThatOfDirectSums) {
  Box const box = box_of<3>();
  std::mt19937_64 random(test_seed(36));
  Ensemble<Newton<3>> one("one", 300), two("two", 200);
  place_anywhere(one, box, random);
  block_load(two, {Lattice::square, 0.4, {5, 5, 8}});
  std::vector<std::uint32_t> const group{0, 5, 7, 100}, partners{1, 2, 3};
  using Names = std::vector<std::string>;
  for (auto const& [names, particles, others] :
       {std::tuple{Names{}, std::vector<std::uint32_t>{}, std::vector<std::uint32_t>{}},
        std::tuple{Names{"two"}, std::vector<std::uint32_t>{}, std::vector<std::uint32_t>{}},
        std::tuple{Names{"one", "two"}, std::vector<std::uint32_t>{}, std::vector<std::uint32_t>{}},
        std::tuple{Names{"one"}, group, std::vector<std::uint32_t>{}}, std::tuple{Names{"one"}, group, partners}}) {
    StructureFactorOptions options{.ensembles = names, .modes = 6, .particles = particles, .partners = others};
    StructureFactor exact({&one, &two}, options);
    options.by = WaveSums::mesh;
    StructureFactor meshed({&one, &two}, options);
    look(exact, {&one, &two}, box);
    look(meshed, {&one, &two}, box, 2);
    ASSERT_EQ(exact.modes(), meshed.modes());
    auto const s = exact.s_of_modes(), found = meshed.s_of_modes();
    double const number = 500, bound = 1.1e-5;  // particles at most
    for (std::size_t m = 0; m < s.size(); ++m)
      EXPECT_NEAR(found[m], s[m], 2 * bound * std::sqrt(number * (std::abs(s[m]) + 1)) + number * bound * bound);
  }
}

TEST(StructureFactorByMesh, OfAnIdealGasIsOneAndOfACrystalItsNumber) {
  Box const box = box_of<3>();
  std::mt19937_64 random(test_seed(37));
  Ensemble<Newton<3>> gas("gas", 1000);
  StructureFactor diagnosis({&gas}, {.modes = 6, .by = WaveSums::mesh});
  constexpr int looks = 20;
  for (int n = 0; n < looks; ++n) {
    place_anywhere(gas, box, random);
    look(diagnosis, {&gas}, box);
  }
  double sum = 0;
  for (double const s : diagnosis.s_of_modes()) sum += s;
  auto const modes = static_cast<double>(diagnosis.modes().size());
  EXPECT_GT(modes, 150);
  EXPECT_NEAR(sum / modes, 1, 5 / std::sqrt(modes * looks));

  Ensemble<Newton<3>> atoms("atoms");
  block_load(atoms, {Lattice::fcc, std::sqrt(0.5), {3, 3, 3}});
  Box const cube(Vector{0.0, 0.0, 0.0}, Vector{3.0, 3.0, 3.0}, Boundary::periodic);
  StructureFactor crystal({&atoms}, {.modes = 7, .by = WaveSums::mesh});
  look(crystal, {&atoms}, cube);
  std::size_t peaks = 0;
  for (std::size_t m = 0; m < crystal.modes().size(); ++m) {
    auto const [x, y, z] = crystal.modes()[m];
    int const h = std::abs(x / 3) % 2, k = std::abs(y / 3) % 2, l = std::abs(z / 3) % 2;
    bool const bragg = x % 3 == 0 && y % 3 == 0 && z % 3 == 0 && h == k && k == l;
    peaks += bragg;
    EXPECT_NEAR(crystal.s_of_modes()[m], bragg ? 108 : 0, bragg ? 108 * 2.3e-5 : 108 * 1.3e-10);
  }
  EXPECT_EQ(peaks, 7U);
}

TEST(StructureFactorByMesh, RefusesWhatHasNoWavesOrTooMany) {
  Ensemble<Newton<2>> atoms("atoms", 2);
  StructureFactor waves({&atoms}, {.by = WaveSums::mesh}), many({&atoms}, {.modes = 800, .by = WaveSums::mesh});
  Box const tube(Vector{0.0, 0.0}, Vector{3.0, 3.0}, {Boundary::periodic, Boundary::mirror});
  EXPECT_NE(message([&] { waves.check(tube); }).find("axis y is not periodic"), std::string::npos);
  Box const box(Vector{0.0, 0.0}, Vector{3.0, 3.0}, Boundary::periodic);
  EXPECT_NE(message([&] { many.check(box); }).find("1e+06 are allowed; choose fewer 'modes'"), std::string::npos);
  EXPECT_EQ(message([&] { wave_sums_words().named("mash"); }),
            "unknown way to sum waves 'mash'; there are direct, mesh; did you mean 'mesh'?");
}

}  // namespace
}  // namespace boltzmann::mesh_amplitudes_test
