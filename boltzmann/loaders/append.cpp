// Appends rows.
#include <boltzmann/core/error.hpp>
#include <boltzmann/loaders/append.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace boltzmann {

void append(AnyEnsemble& ensemble, AnyEnsemble const& more) {
  auto const alike = [](Field const& a, Field const& b) {
    return a.name == b.name && a.offset == b.offset && a.components == b.components;
  };
  auto const &to = ensemble.fields(), &from = more.fields();
  if (ensemble.class_name() != more.class_name() || ensemble.dimension() != more.dimension() ||
      !std::equal(to.begin(), to.end(), from.begin(), from.end(), alike))
    throw Error(fmt::format("particles of class {} in {}D can't be added to '{}', whose class is {} in {}D",
                            more.class_name(), more.dimension(), ensemble.name(), ensemble.class_name(),
                            ensemble.dimension()));
  std::size_t const before = ensemble.size(), added = more.size();
  ensemble.resize(before + added);
  for (std::size_t i = 0; i < added; ++i) std::copy_n(more.row(i), ensemble.doubles(), ensemble.row(before + i));
}

}  // namespace boltzmann
