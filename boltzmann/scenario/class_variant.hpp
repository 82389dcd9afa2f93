// The entry of one class in the table of classes. Private to this module.
#pragma once

#include <boltzmann/integrators/methods.hpp>
#include <boltzmann/scenario/classes.hpp>

namespace boltzmann::detail {

template <class P>
SourceKind source_kind_of() {
  if constexpr (FieldParticle<P>)
    return source_kind<P>();
  else
    return {};
}

template <class P>
ClassVariant variant_of() {
  return {P::dimension,
          [](std::string name, std::size_t size) -> std::unique_ptr<AnyEnsemble> {
            return std::make_unique<Ensemble<P>>(std::move(name), size);
          },
          [](AnyEnsemble& ensemble, Method method) { return make_integrator_as<P>(ensemble, method); },
          P::fields().fields,
          sizeof(Row<P>) + sizeof(typename P::Influence),
          usual_method<P>(),
          source_kind_of<P>()};
}

}  // namespace boltzmann::detail
