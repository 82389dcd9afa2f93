// Adds particles to a scheme.
#include <boltzmann/schemes/scheme.hpp>
#include <boltzmann/schemes/vortices/vortex_source.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace boltzmann {

std::uint64_t Scheme::revision_with(std::initializer_list<std::uint64_t> others) const {
  constexpr std::uint64_t odd = 0x9E3779B97F4A7C15U;
  std::uint64_t revision = changes_ * odd + box_.revision();
  for (auto const other : others) revision = revision * odd + other;
  return revision;
}

void Scheme::add(AnyEnsemble& ensemble) {
  if (std::find(ensembles_.begin(), ensembles_.end(), &ensemble) != ensembles_.end()) return;
  for (auto const* other : ensembles_)
    if (other->name() == ensemble.name())
      throw Error("two ensembles are called '" + ensemble.name() + "'; each needs a name of its own");
  box_.check(ensemble);
  ensembles_.push_back(&ensemble);
  changed();
}

bool Scheme::supervises(AnyEnsemble const& ensemble) const {
  auto const& all = ensembles();
  return std::find(all.begin(), all.end(), &ensemble) != all.end();
}

std::string Scheme::at_one_place(AnyEnsemble const& ensemble, std::size_t i) const {
  int const dimension = ensemble.dimension();
  double const* x = ensemble.row(i);
  for (auto const* other : ensembles())
    for (std::size_t j = 0; j < other->size(); ++j) {
      if (other == &ensemble && i == j) continue;
      double d[3] = {0, 0, 0};
      for (int a = 0; a < dimension; ++a) d[a] = other->row(j)[a] - x[a];
      box().nearest_image(d);
      if (d[0] == 0 && d[1] == 0 && d[2] == 0)
        return fmt::format(
            "particle {} of '{}' and particle {} of '{}' are at the same place, where their law is not finite", i,
            ensemble.name(), j, other->name());
    }
  return "";
}

std::vector<AnyEnsemble*> supervised_by(std::vector<Scheme*> const& schemes) {
  std::vector<AnyEnsemble*> all;
  for (auto* scheme : schemes)
    for (auto* ensemble : scheme->ensembles())
      if (std::find(all.begin(), all.end(), ensemble) == all.end()) all.push_back(ensemble);
  return all;
}

std::vector<MeshField const*> mesh_fields_of(std::vector<Scheme*> const& schemes) {
  std::vector<MeshField const*> all;
  for (auto* scheme : schemes)
    for (auto const* field : scheme->mesh_fields()) all.push_back(field);
  return all;
}

std::vector<VortexSource> Scheme::vortices() const { return {}; }

}  // namespace boltzmann
