// Converts a law that returns a force to one that returns the influence on smooth particles.
#pragma once

#include <boltzmann/laws/parameter.hpp>

namespace boltzmann {

/// Calls law(p) or law(p, time), and returns its force as an influence without heat.
template <class Law>
struct ForceOn {
  Law law;

  template <class P, class... Time>
  auto operator()(P const& p, Time... time) const requires requires(Law const& l) {
    l(p, time...);
  }
  {
    auto const result = law(p, time...);
    typename P::Influence influence{};
    if constexpr (requires { result.energy; }) {
      struct Both {
        typename P::Influence force;
        double energy;
      };
      influence.force = result.force;
      return Both{influence, result.energy};
    } else {
      influence.force = result;
      return influence;
    }
  }

  void check() const { check_parameters(law); }
};

}  // namespace boltzmann
