// Files of embedded atoms: setfl and funcfl give the functions that they were made of, and say what is wrong with them.
#include <boltzmann/boltzmann.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <tests/message.hpp>

#include <filesystem>
#include <fstream>

namespace boltzmann::embedded_file_test {
namespace {

constexpr int points = 1001;
constexpr double cutoff = 5.5, spacing = cutoff / (points - 1), densities = 0.05;

/// Functions that end smoothly at the cut-off, of elements by number.
double ending(double r) { return r < cutoff ? std::pow(1 - r / cutoff, 3) : 0; }
double pair(int a, int b, double r) { return (30 + 5 * (a + b)) * std::exp(-1.9 * r) * ending(r); }
double density(int b, double r) { return (b == 0 ? 9 : 7) * std::exp(-0.9 * r) * ending(r); }
double embedding(int a, double rho) { return -(a == 0 ? 1.1 : 1.4) * std::sqrt(rho) + 0.01 * rho; }

class File {
 public:
  File() : path_(std::filesystem::temp_directory_path() / fmt::format("embedded_{}.txt", ::getpid())) {}
  ~File() { std::filesystem::remove(path_); }
  std::string path() const { return path_.string(); }
  void write(std::string const& text) const { std::ofstream(path_) << text; }
  /// What from_file says, without the name of the file.
  std::string error() const {
    auto const line = message([&] { EmbeddedAtoms::from_file(path(), UnitSystem()); });
    return line.starts_with(path()) ? line.substr(path().size() + 1) : line;
  }

 private:
  std::filesystem::path path_;
};

std::string numbers(int count, auto const& value) {
  std::string text;
  for (int k = 0; k < count; ++k) text += fmt::format("{:.16e}{}", value(k), k % 5 == 4 || k + 1 == count ? "\n" : " ");
  return text;
}

std::string head() { return fmt::format("{} {} {} {} {}\n", points, densities, points, spacing, cutoff); }

std::string setfl(int elements) {
  std::string text = "made for a test\nof two metals\nthat don't exist\n";
  text += elements == 1 ? "1 Aa\n" : "2 Aa Bb\n";
  text += head();
  for (int a = 0; a < elements; ++a) {
    text += "29 63.55 3.615 FCC\n";
    text += numbers(points, [&](int k) { return embedding(a, k * densities); });
    text += numbers(points, [&](int k) { return density(a, k * spacing); });
  }
  for (int a = 0; a < elements; ++a)
    for (int b = 0; b <= a; ++b) text += numbers(points, [&](int k) { return k * spacing * pair(a, b, k * spacing); });
  return text;
}

TEST(EmbeddedFile, GivesTheFunctionsItWasMadeOf) {
  UnitSystem const units(1 * units::angstrom, 1 * units::amu, 1 * units::picosecond);
  double const eV = units(1 * units::electronvolt);
  File file;
  file.write(setfl(2));
  auto const atoms = EmbeddedAtoms::from_file(file.path(), units);
  ASSERT_EQ(atoms.elements().size(), 2u);
  EXPECT_EQ(atoms.elements()[1].name, "Bb");
  EXPECT_NEAR(atoms.cutoff(), cutoff, 1e-9);
  for (double r = 1.1; r < cutoff; r += 0.0731)
    for (std::size_t a = 0; a < 2; ++a)
      for (std::size_t b = 0; b < 2; ++b) {
        EXPECT_NEAR(atoms.pair_energy(r, a, b) / eV, pair(int(a), int(b), r), 1e-6);
        EXPECT_NEAR(atoms.density(r, a, b), density(int(b), r), 1e-6);
      }
  for (double const rho : {0.51, 3.3, 17.0, 49.0}) {
    double energy = 0, slope = 0;
    atoms.elements()[1].embedding->at(&rho, 1, &energy, &slope);
    EXPECT_NEAR(energy / eV, embedding(1, rho), 1e-5);
    EXPECT_NEAR(slope / eV, -0.7 / std::sqrt(rho) + 0.01, 1e-4);
  }
  // Beyond the last density it goes on as it was.
  double const beyond[2] = {50, 60};
  double energy[2], slope[2];
  atoms.elements()[0].embedding->at(beyond, 2, energy, slope);
  EXPECT_NEAR(energy[1], energy[0] + 10 * slope[0], 1e-9);
  EXPECT_EQ(slope[1], slope[0]);
}

// eam.fs: the density of an atom depends on the element at which it acts, too.
double density_at(int source, int place, double r) { return density(source, r) * (1 + 0.3 * place); }

std::string finnis_sinclair() {
  std::string text = "made for a test\nof two metals\nthat don't exist\n2 Aa Bb\n" + head();
  for (int a = 0; a < 2; ++a) {
    text += "29 63.55 3.615 FCC\n" + numbers(points, [&](int k) { return embedding(a, k * densities); });
    for (int b = 0; b < 2; ++b) text += numbers(points, [&](int k) { return density_at(a, b, k * spacing); });
  }
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b <= a; ++b) text += numbers(points, [&](int k) { return k * spacing * pair(a, b, k * spacing); });
  return text;
}

TEST(EmbeddedFile, OfFinnisAndSinclairHasADensityForEachTwoElements) {
  UnitSystem const units(1 * units::angstrom, 1 * units::amu, 1 * units::picosecond);
  double const eV = units(1 * units::electronvolt);
  File file;
  file.write(finnis_sinclair());
  auto const atoms = EmbeddedAtoms::from_file(file.path(), units);
  for (double r = 1.1; r < cutoff; r += 0.0731)
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) {
        auto const x = std::size_t(a), y = std::size_t(b);
        EXPECT_NEAR(atoms.pair_energy(r, x, y) / eV, pair(a, b, r), 1e-6);
        EXPECT_NEAR(atoms.density(r, x, y), density_at(b, a, r), 1e-6);  // that of b at a
      }
  // Energies and forces of five atoms, against sums over all pairs.
  Ensemble<Newton<3>> first("first", 3), second("second", 2);
  EmbeddedAtomScheme scheme(Box({-20, -20, -20}, {20, 20, 20}, Boundary::open), atoms);
  scheme.add(first, "Aa");
  scheme.add(second, "Bb");
  std::vector<std::pair<int, double*>> all;
  for (auto& p : first) all.emplace_back(0, &p.position[0]);
  for (auto& p : second) all.emplace_back(1, &p.position[0]);
  double const places[5][3] = {{0, 0, 0}, {2.1, 0.3, 0}, {0.4, 2.5, 0.2}, {1.5, 1.2, 1.9}, {-1.7, 0.8, 1.1}};
  for (std::size_t i = 0; i < 5; ++i) std::copy_n(places[i], 3, all[i].second);
  auto const energy = [&] {
    double sum = 0;
    for (auto const& [a, x] : all) {
      double rho = 0;
      for (auto const& [b, y] : all) {
        double const r = std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]);
        if (x == y || r >= cutoff) continue;
        rho += density_at(b, a, r);
        sum += 0.5 * pair(a, b, r);
      }
      sum += embedding(a, rho);
    }
    return sum;
  };
  scheme.calculate(0);
  EXPECT_NEAR(scheme.measure().potential / eV, energy(), 1e-4);
  for (std::size_t i = 0; i < 5; ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      double const h = 1e-5, x = all[i].second[c];
      all[i].second[c] = x + h;
      double const up = energy();
      all[i].second[c] = x - h;
      double const down = energy();
      all[i].second[c] = x;
      double const force = i < 3 ? first.influence(i)[c] : second.influence(i - 3)[c];
      EXPECT_NEAR(force / eV, (down - up) / (2 * h), 2e-3) << i << " " << c;
    }
}

TEST(EmbeddedFile, MoreNumbersThanItsTablesAreRefused) {
  File file;
  file.write(setfl(2) + "\n\nmade by hand\n");
  EXPECT_NO_THROW(EmbeddedAtoms::from_file(file.path(), UnitSystem()));
  file.write(setfl(2) + numbers(points, [](int) { return 0.5; }));  // as files of adp have them
  EXPECT_NE(file.error().find("follows the last table"), std::string::npos) << file.error();
}

TEST(EmbeddedFile, OfTheOlderFormatHasEffectiveCharges) {
  File file;
  auto const charge = [](double r) { return 4 * ending(r); };
  file.write("made for a test\n29 63.55 3.615 FCC\n" + head() +
             numbers(points, [](int k) { return embedding(0, k * densities); }) +
             numbers(points, [&](int k) { return charge(k * spacing); }) +
             numbers(points, [](int k) { return density(0, k * spacing); }));
  auto const atoms = EmbeddedAtoms::from_file(file.path(), UnitSystem());
  double const eV = UnitSystem()(1 * units::electronvolt), angstrom = 1e-10;
  for (double r = 1.1; r < cutoff; r += 0.0731) {
    EXPECT_NEAR(atoms.pair_energy(r * angstrom) / eV, 27.2 * 0.529 * charge(r) * charge(r) / r, 1e-5);
    EXPECT_NEAR(atoms.density(r * angstrom), density(0, r), 1e-6);
  }
}

TEST(EmbeddedFile, SaysWhatIsWrongWithIt) {
  File file;
  std::string const whole = setfl(2);
  auto const with = [&](std::string const& what, std::string const& other) {
    std::string text = whole;
    text.replace(text.find(what), what.size(), other);
    file.write(text);
    return file.error();
  };
  EXPECT_EQ(message([] { EmbeddedAtoms::from_file("/nowhere/x", UnitSystem()); }), "/nowhere/x: can't open the file");
  file.write(whole.substr(0, whole.size() / 2));
  EXPECT_NE(file.error().find("the file ends before line"), std::string::npos) << file.error();
  EXPECT_NE(file.error().find("is to be"), std::string::npos) << file.error();
  file.write("one\ntwo\n");
  EXPECT_EQ(file.error(), " the file ends before line 3, a comment, or the head of a table");
  file.write("one\ntwo\nthree\nfour\n");
  EXPECT_EQ(file.error(),
            "2: neither setfl (line 4 has the number of elements and their names) nor funcfl (line 2 has the atomic "
            "number, mass and lattice of one element)");
  EXPECT_EQ(with("2 Aa Bb", "3 Aa Bb"), "4: 3 elements and 2 names; as many of both are needed, up to 10");
  EXPECT_EQ(with(head(), "3 0.1 1001 0.1 5\n"), "5: Nrho = 3; a whole number from 5 to 1000000 is needed");
  EXPECT_EQ(with(head(), "100 0.1 1001 0.1\n"), "5: 4 words; the line \"Nrho drho Nr dr cutoff\" has 5 numbers");
  EXPECT_EQ(with(head(), "100 0.1 1001 -0.1 5\n"), "5: dr = -0.1 must be positive");
  std::string const first = whole.substr(whole.find("FCC\n") + 4, 10);
  EXPECT_EQ(with(first, "nonsense "), "7: 'nonsense' is not a finite number");
  EXPECT_NE(with(first, "1 2 3 4 5 ").find("follows the last of the 1001 numbers of the embedding energies of Aa"),
            std::string::npos);
}

}  // namespace
}  // namespace boltzmann::embedded_file_test
