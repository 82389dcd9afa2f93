// Chosen ensembles: selects the ensembles of a diagnosis by name, and names its columns and files.
#pragma once

#include <boltzmann/diagnoses/diagnosis.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace boltzmann {

/// Error with all names if there is none.
AnyEnsemble const& ensemble_named(std::vector<AnyEnsemble const*> const& available, std::string const& name);
/// The names, or those of all ensembles if empty. Error if one does not exist, or there are no ensembles.
std::vector<std::string> chosen_names(std::vector<AnyEnsemble const*> const& available,
                                      std::vector<std::string> const& names);
/// Its index in the sample. Error if it is no longer in the simulation.
std::size_t index_in(Sample const& sample, std::string const& name);
AnyEnsemble const& ensemble_of(Sample const& sample, std::string const& name);

/// Checks numbers of particles of one ensemble: of the named one, or of the only one. Error if there are several, or it
/// has no such particle. Does nothing without numbers.
void check_chosen(std::vector<AnyEnsemble const*> const& available, std::vector<std::string> const& names,
                  std::span<std::uint32_t const> particles);

/// Checks two groups of one ensemble, the sides of pairs, in the same way. Also an Error if the first is missing, or a
/// particle occurs twice.
void check_chosen(std::vector<AnyEnsemble const*> const& available, std::vector<std::string> const& names,
                  std::span<std::uint32_t const> particles, std::span<std::uint32_t const> partners);
/// The members of the group; all particles if it is empty.
std::vector<std::uint32_t> members_of(AnyEnsemble const& ensemble, std::span<std::uint32_t const> particles);

/// "a, b" -> {"a", "b"}.
std::vector<std::string> split_names(std::string const& text);
/// "momentum x", "momentum y", ...
std::vector<Column> along_axes(std::string const& what, int axes, Dimension dimension);
/// "Na Cl g peak": the column `what` of a diagnosis with this label, which may be empty.
std::string labelled(std::string const& label, std::string const& what);
/// "radial-distribution-Na-Cl": the file of a diagnosis with this label, of letters, digits, '-', '_' and '.'.
std::string file_name(std::string const& kind, std::string const& label);

/// Reads the numbers of a checkpoint's state in order. Error if there are too few or too many.
class StateReader {
 public:
  explicit StateReader(std::span<double const> state) : left_(state) {}
  double next() { return next(1)[0]; }
  std::span<double const> next(std::size_t count);
  /// A list with its length before it.
  std::vector<double> list();
  void finish() const;

 private:
  std::span<double const> left_;
};
/// The inverse.
void add_list(std::vector<double>& state, std::span<double const> list);

}  // namespace boltzmann
