// Chosen ensembles: who a diagnosis looks at, by name, and the names of what it gives.
#pragma once

#include <boltzmann/diagnoses/diagnosis.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace boltzmann {

/// Error that lists the names there are.
AnyEnsemble const& ensemble_named(std::vector<AnyEnsemble const*> const& available, std::string const& name);
/// The names, all ensembles' if there are none. Error if one is not there, or there is nobody to look at.
std::vector<std::string> chosen_names(std::vector<AnyEnsemble const*> const& available,
                                      std::vector<std::string> const& names);
/// Its place in the sample. Error if it is not in the simulation any more.
std::size_t index_in(Sample const& sample, std::string const& name);
AnyEnsemble const& ensemble_of(Sample const& sample, std::string const& name);

/// Numbers of particles of one ensemble: of the one that is named, or that there is. Error if there are several, or one has
/// no such particle. Nothing without numbers.
void check_chosen(std::vector<AnyEnsemble const*> const& available, std::vector<std::string> const& names,
                  std::span<std::uint32_t const> particles);

/// Two groups of one ensemble, the sides of pairs: the same, and Error if the first is missing, or they have a particle in
/// common or twice.
void check_chosen(std::vector<AnyEnsemble const*> const& available, std::vector<std::string> const& names,
                  std::span<std::uint32_t const> particles, std::span<std::uint32_t const> partners);
/// Those of the group; all if there is none.
std::vector<std::uint32_t> members_of(AnyEnsemble const& ensemble, std::span<std::uint32_t const> particles);

/// "a, b" -> {"a", "b"}.
std::vector<std::string> split_names(std::string const& text);
/// "momentum x", "momentum y", ...
std::vector<Column> along_axes(std::string const& what, int axes, Dimension dimension);
/// "Na Cl g peak": the column `what` of a diagnosis with this label, which may be empty.
std::string labelled(std::string const& label, std::string const& what);
/// "radial-distribution-Na-Cl": the file of a diagnosis with this label, of letters, digits, '-', '_' and '.'.
std::string file_name(std::string const& kind, std::string const& label);

/// Numbers of a checkpoint's state, one after the other. Error where there are none left, or left over.
class StateReader {
 public:
  explicit StateReader(std::span<double const> state) : left_(state) {}
  double next() { return next(1)[0]; }
  std::span<double const> next(std::size_t count);
  /// A list behind its length.
  std::vector<double> list();
  void finish() const;

 private:
  std::span<double const> left_;
};
/// The same the other way.
void add_list(std::vector<double>& state, std::span<double const> list);

}  // namespace boltzmann
