// Between the passes: the derivative of each atom's embedding energy with respect to its density.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/kernel_dispatch.hpp>
#include <boltzmann/schemes/many_body/atom_point.hpp>
#include <boltzmann/schemes/many_body/embedded_atom_scheme.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

constexpr double left_at_cutoff = 1e-3;  // relative to the value at half of the cut-off

template <template <int, class> class Point>
std::unique_ptr<AnyEnsemble> points_in(int dimension) {
  constexpr auto name = "embedded atoms";
  if (dimension == 1) return std::make_unique<Ensemble<Point<1, double>>>(name);
  if (dimension == 2) return std::make_unique<Ensemble<Point<2, double>>>(name);
  return std::make_unique<Ensemble<Point<3, double>>>(name);
}

std::unique_ptr<AnyEnsemble> points_for(int dimension, EmbeddedAtoms const& atoms) {
  return atoms.elements().size() > 1 ? points_in<AlloyPoint>(dimension) : points_in<EmbeddedPoint>(dimension);
}

std::string names_of(EmbeddedAtoms const& atoms) {
  std::string names;
  for (auto const& element : atoms.elements()) names += (names.empty() ? "" : ", ") + element.name;
  return names;
}

/// Densities are rounded to this quantum, so that their sums are exact. It is far below the contributions of
/// neighbours, and large enough that sums in a collision fit.
double density_quantum(EmbeddedAtoms const& atoms) {
  double largest = 0;
  for (std::size_t a = 0; a < atoms.elements().size(); ++a)
    for (std::size_t b = 0; b < atoms.elements().size(); ++b)
      largest = std::max(largest, std::abs(atoms.density(atoms.length_scale(), a, b)));
  return largest > 0 ? std::ldexp(1.0, std::ilogb(largest) - 36) : 0;
}

}  // namespace

EmbeddedAtomScheme::EmbeddedAtomScheme(Box box, EmbeddedAtoms atoms)
    : ManyBodyScheme(box, atoms.cutoff(), points_for(box.dimension(), atoms), 0),
      atoms_(std::move(atoms)),
      tables_(atoms_.tables()) {}

void EmbeddedAtomScheme::add(AnyEnsemble& ensemble, std::string_view element) {
  auto const& elements = atoms_.elements();
  std::size_t number = 0;
  if (element.empty()) {
    if (alloy())
      throw Error(fmt::format("which element is '{}'? These are known: {}", ensemble.name(), names_of(atoms_)));
  } else {
    auto const found = std::find_if(elements.begin(), elements.end(), [&](auto const& e) { return e.name == element; });
    if (found == elements.end())
      throw Error(fmt::format("'{}' is of element {}, which is not among those known: {}", ensemble.name(), element,
                              names_of(atoms_)));
    number = static_cast<std::size_t>(found - elements.begin());
  }
  add_atoms(ensemble, number);
}

ManyBodyScheme::Passes EmbeddedAtomScheme::passes() const {
  auto const& table = for_instruction_set(
      [](auto set) -> ManyBodyKernelTable const& { return many_body_kernels<decltype(set)::value>(); });
  auto const D = static_cast<std::size_t>(box().dimension());
  Passes passes;
  passes.kernels = (alloy() ? table.alloy : table.embedded)[D - 1];
  passes.law = &tables_;
  passes.first = alloy() ? D + 1 : D;
  passes.sum_quantum = density_quantum(atoms_);
  return passes;
}

void EmbeddedAtomScheme::answer(Atoms const& atoms) const {
  std::vector<double> density, energy, slope;
  std::vector<std::size_t> members;
  auto const D = static_cast<std::size_t>(box().dimension());
  for (std::size_t element = 0; element < atoms_.elements().size(); ++element) {
    members.clear(), density.clear();
    for (std::size_t k = 0; k < atoms.size; ++k)
      if (!alloy() || atoms.rows[row_block * k + D] == static_cast<double>(element)) {
        members.push_back(k);
        density.push_back(std::max(atoms.sums[k], 0.0));
      }
    energy.resize(density.size()), slope.resize(density.size());
    atoms_.elements()[element].embedding->at(density.data(), density.size(), energy.data(), slope.data());
    for (std::size_t m = 0; m < members.size(); ++m) {
      atoms.answers[members[m]] = density[m] > 0 ? slope[m] : 0;  // without neighbours, the slope affects no other atom
      if (atoms.energies) atoms.energies[members[m]] = energy[m];
    }
  }
}

double EmbeddedAtomScheme::length_scale(AnyEnsemble const& ensemble) const {
  return supervises(ensemble) ? atoms_.length_scale() : __builtin_inf();
}

std::vector<std::string> EmbeddedAtomScheme::warnings(double) {
  std::vector<std::string> lines;
  double const end = atoms_.cutoff() * (1 - 1e-9), half = atoms_.cutoff() / 2;
  auto const left = [&](auto const& of) { return std::abs(of(end)) / std::abs(of(half)); };
  for (std::size_t a = 0; a < atoms_.elements().size(); ++a) {
    double const pair = left([&](double r) { return atoms_.pair_energy(r, a, a); });
    double const density = left([&](double r) { return atoms_.density(r, a, a); });
    if (std::max(pair, density) > left_at_cutoff)
      lines.push_back(
          fmt::format("warning: at the cut-off {} there is still {:.2g} of the {} at half of it: energies jump there",
                      spoken_units().text(atoms_.cutoff(), dimensions::length), std::max(pair, density),
                      pair > density ? "pair energy" : "density"));
  }
  return lines;
}

std::string EmbeddedAtomScheme::summary() const {
  return alloy() ? fmt::format("embedded atoms of {}", names_of(atoms_)) : "embedded atoms";
}

}  // namespace boltzmann
