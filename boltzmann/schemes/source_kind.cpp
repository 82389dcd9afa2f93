// Signs of interactions, and their check.
#include <boltzmann/core/error.hpp>
#include <boltzmann/schemes/source_kind.hpp>

#include <fmt/format.h>

namespace boltzmann {

void SourceKind::check(AnyEnsemble const& ensemble, double constant, char const* scheme) const {
  if (sign * constant < 0)
    throw Error(fmt::format("{}: class {} of '{}' {}, but with the constant {} equal strengths {}; use {}", scheme,
                            ensemble.class_name(), ensemble.name(), sign > 0 ? "repels its like" : "attracts", constant,
                            constant > 0 ? "repel" : "attract", sign > 0 ? "coulomb(k)" : "gravity(G)"));
}

}  // namespace boltzmann
