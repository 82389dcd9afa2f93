// Embedded atoms: metals, whose cohesion depends on the density of neighbours at each atom (Daw and Baskes 1984): E =
// sum_i F(rho_i) + 1/2 sum_ij V(r_ij), rho_i = sum_j rho(r_ij).
#pragma once

#include <boltzmann/core/dual.hpp>
#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/laws/embedded_tables.hpp>
#include <boltzmann/laws/table.hpp>

#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace boltzmann {

/// The energy F of atoms as a function of the density.
class Embedding {
 public:
  virtual ~Embedding() = default;
  /// F and dF/d(density) of each of `size` densities, which are zero or positive; the slope at zero is not used.
  virtual void at(double const* density, std::size_t size, double* energy, double* slope) const = 0;
};

/// F as a function of one number, generic in its type: the slope follows by automatic differentiation.
template <class Function>
class EmbeddingFunction final : public Embedding {
 public:
  explicit EmbeddingFunction(Function function) : function_(std::move(function)) {}
  void at(double const* density, std::size_t size, double* energy, double* slope) const override {
    for (std::size_t k = 0; k < size; ++k) {
      Dual<double, Radial<double>> const result = function_(Dual<double, Radial<double>>{density[k], {1.0}});
      energy[k] = result.value;
      slope[k] = result.derivative.slope;
    }
  }

 private:
  Function function_;
};

/// One element: its name, and the energy of its atoms as a function of the density.
struct EmbeddedElement {
  std::string name;
  std::shared_ptr<Embedding const> embedding;
};

/// The laws of Sutton and Chen (1990), V = epsilon (a/r)^n, rho = (a/r)^m, F = -c epsilon sqrt(rho): the lattice
/// constant is a if c = n S_n / (m sqrt(S_m)), S_k being the sum of (a/r)^k over the lattice.
struct SuttonChen {
  double epsilon, a, n, m, c;
};
/// The laws of Gupta with the parameters of Cleri and Rosato (1993): V = 2 A exp(-p (r/r0 - 1)), rho = xi^2 exp(-2 q
/// (r/r0 - 1)), F = -sqrt(rho).
struct Gupta {
  double A, xi, p, q, r0;
};

/// The range of pair energies and densities: from `switch_from` on they are multiplied by a factor that falls from 1 to
/// 0 with three continuous derivatives. Below `first` they are not tabulated, but continued as straight lines in r^2.
struct EmbeddedReach {
  double cutoff;
  double switch_from = -1;  ///< negative: 0.9 of the cut-off
  double first = -1;        ///< negative: 0.05 of the cut-off
};

class EmbeddedAtoms {
 public:
  /// A function of the distance, for the elements with these numbers. A pair energy is symmetric in a and b; a density
  /// is that of b at a.
  using Between = std::function<double(std::size_t a, std::size_t b, double r)>;

  /// Several elements. `tolerance`: the error of the splines (TableError::relative). Error as of Table, and if a reach
  /// is not 0 < first < switch_from <= cutoff.
  EmbeddedAtoms(std::vector<EmbeddedElement> elements, Between const& pair, Between const& density,
                EmbeddedReach const& reach, Tolerance tolerance = {3e-6});
  /// One element; pair(r), density(r), and embedding(rho), which is generic in its number: [](auto const& rho) { return
  /// -sqrt(rho); }.
  template <class Function>
  EmbeddedAtoms(std::function<double(double)> const& pair, std::function<double(double)> const& density,
                Function const& embedding, EmbeddedReach const& reach, Tolerance tolerance = {3e-6})
      : EmbeddedAtoms(
            {{"", std::make_shared<EmbeddingFunction<Function>>(embedding)}},
            [&](std::size_t, std::size_t, double r) { return pair(r); },
            [&](std::size_t, std::size_t, double r) { return density(r); }, reach, tolerance) {}
  EmbeddedAtoms(SuttonChen const& law, EmbeddedReach const& reach);
  EmbeddedAtoms(Gupta const& law, EmbeddedReach const& reach);
  /// The tables of a file in the format setfl (eam.alloy, eam.fs: several elements) or funcfl (one), in eV and
  /// angstrom, up to their cut-off. The splines pass through the numbers of the file. Error, "file:line: what is
  /// wrong".
  static EmbeddedAtoms from_file(std::string const& path, UnitSystem const& units);

  std::vector<EmbeddedElement> const& elements() const { return elements_; }
  double cutoff() const { return cutoff_; }
  double first() const { return first_; }
  /// The largest of the errors of all splines.
  double error() const { return error_; }
  std::size_t intervals() const { return intervals_; }
  /// Pair energy and density (of b at a) by the splines.
  double pair_energy(double r, std::size_t a = 0, std::size_t b = 0) const { return value(r, a, b, 1); }
  double density(double r, std::size_t a = 0, std::size_t b = 0) const { return value(r, a, b, 0); }
  /// A third of the cut-off, approximately the distance of neighbours.
  double length_scale() const { return cutoff_ / 3; }
  EmbeddedTables tables() const;

 private:
  struct alignas(64) Line {
    double c[8];
  };
  /// A table for two elements, with the requested fineness.
  using Tabulate = std::function<Table(std::size_t a, std::size_t b, PerOctave)>;

  EmbeddedAtoms(std::vector<EmbeddedElement> elements, Tabulate const& pair, Tabulate const& density,
                std::size_t finest, double tolerance);
  double value(double r, std::size_t a, std::size_t b, int block) const;

  std::vector<EmbeddedElement> elements_;
  OctaveKnots knots_;
  std::size_t intervals_ = 0;
  std::shared_ptr<std::vector<Line> const> lines_;
  double cutoff_ = 0, first_ = 0, error_ = 0;
};

}  // namespace boltzmann
