// Names of ensembles and of columns.
#include <boltzmann/core/error.hpp>
#include <boltzmann/diagnoses/instruments.hpp>

#include <fmt/format.h>

namespace boltzmann::instruments {

std::vector<std::string> names_of(std::vector<AnyEnsemble const*> const& ensembles) {
  std::vector<std::string> names;
  names.reserve(ensembles.size());
  for (auto const* ensemble : ensembles) names.push_back(ensemble->name());
  return names;
}

AnyEnsemble const& ensemble_named(std::vector<AnyEnsemble const*> const& ensembles, std::string const& name) {
  for (auto const* ensemble : ensembles)
    if (ensemble->name() == name) return *ensemble;
  auto const names = names_of(ensembles);
  throw Error(fmt::format("there is no ensemble '{}'; there are {}{}", name, join(names), did_you_mean(name, names)));
}

std::size_t index_in(Sample const& sample, std::string const& name) {
  for (std::size_t e = 0; e < sample.ensembles.size(); ++e)
    if (sample.ensembles[e]->name() == name) return e;
  throw Error(fmt::format("a diagnosis looks for ensemble '{}', which is not in the simulation", name));
}

std::vector<Column> along_axes(std::string const& what, int axes, Dimension dimension) {
  std::vector<Column> columns;
  columns.reserve(static_cast<std::size_t>(axes));
  for (int a = 0; a < axes; ++a) columns.push_back({what + " " + "xyz"[a], dimension});
  return columns;
}

std::string prefixed(std::string const& prefix, std::string const& what) {
  return prefix.empty() ? what : prefix + " " + what;
}

int dimension_of(DiagnosisParameters const& parameters) {
  if (parameters.available.empty()) throw Error("a diagnosis needs an ensemble to look at; the simulation has none");
  return parameters.available.front()->dimension();
}

}  // namespace boltzmann::instruments
