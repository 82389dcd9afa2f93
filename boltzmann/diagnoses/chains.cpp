// Sizes of chains, each followed from bond to bond.
#include <boltzmann/diagnoses/chains.hpp>

#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/core/vector.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

void check_chains(AnyEnsemble const& ensemble, std::size_t length) {
  if (ensemble.size() % length != 0)
    throw Error(fmt::format("'{}' has {} particles, no whole number of chains of {}", ensemble.name(), ensemble.size(),
                            length));
}

/// For one ensemble.
struct ChainSizes {
  ExactSum ends, gyration, bonds;

  /// Adds one chain, from particle `first` on.
  void add(AnyEnsemble const& ensemble, Box const& box, std::size_t first, std::size_t length) {
    Vector<3> at{0, 0, 0}, sum{0, 0, 0};
    double squares = 0;
    for (std::size_t i = first + 1; i < first + length; ++i) {
      Vector<3> bond{0, 0, 0};
      for (int a = 0; a < ensemble.dimension(); ++a) bond[a] = ensemble.row(i)[a] - ensemble.row(i - 1)[a];
      box.nearest_image(bond.component);
      at += bond;
      sum += at;
      squares += norm2(at);
      bonds += norm2(bond);
    }
    double const n = static_cast<double>(length);
    ends += norm2(at);
    gyration += squares / n - norm2(sum * (1 / n));
  }
};

}  // namespace

Chains::Chains(std::vector<AnyEnsemble const*> const& available, std::vector<std::string> const& names,
               std::size_t length)
    : length_(length), prefixed_(!names.empty() || available.size() > 1) {
  if (length < 2) throw Error(fmt::format("a chain has 2 particles or more, not {}", length));
  std::vector<std::string> known;
  for (auto const* ensemble : available) known.push_back(ensemble->name());
  names_ = names.empty() ? known : names;
  for (auto const& name : names_) {
    auto const found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) throw Error(fmt::format("there is no ensemble '{}'{}", name, choices(name, known)));
    check_chains(*available[static_cast<std::size_t>(found - known.begin())], length);
  }
}

std::vector<Column> Chains::columns() const {
  using dimensions::length;
  std::vector<Column> columns;
  for (auto const& name : names_) {
    std::string const prefix = prefixed_ ? name + " " : "";
    columns.push_back({prefix + "end-to-end distance squared", length * length});
    columns.push_back({prefix + "radius of gyration squared", length * length});
    columns.push_back({prefix + "bond length", length});
  }
  return columns;
}

void Chains::measure(Sample const& sample, std::vector<double>& values) {
  for (auto const& name : names_) {
    auto const found = std::find_if(sample.ensembles.begin(), sample.ensembles.end(),
                                    [&](AnyEnsemble const* ensemble) { return ensemble->name() == name; });
    if (found == sample.ensembles.end())
      throw Error(fmt::format("a diagnosis needs ensemble '{}', which is not in the simulation", name));
    check_chains(**found, length_);
    ChainSizes sizes;
    for (std::size_t first = 0; first < (*found)->size(); first += length_)
      sizes.add(**found, sample.box, first, length_);
    double const chains = static_cast<double>((*found)->size() / length_);
    values.push_back(sizes.ends.value() / chains);
    values.push_back(sizes.gyration.value() / chains);
    values.push_back(std::sqrt(sizes.bonds.value() / (chains * static_cast<double>(length_ - 1))));
  }
}

}  // namespace boltzmann
