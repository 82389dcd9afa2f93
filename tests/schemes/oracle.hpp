// The scalar oracle: every pair and every periodic image, one after the other, in plain doubles. What the engine must
// agree with.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/laws/interaction.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <cmath>
#include <vector>

namespace boltzmann::oracle {

struct Result {
  std::vector<std::vector<double>> influence;  // per target particle
  double energy = 0;                           // half of each pair seen from the target
};

template <class P, class Q, class Law>
Result influences(Ensemble<P> const& target, Ensemble<Q> const& source, Law const& law, Box const& box, double cutoff) {
  Result result;
  bool const same = static_cast<void const*>(&target) == static_cast<void const*>(&source);
  int images[3] = {0, 0, 0};
  for (int a = 0; a < box.dimension(); ++a)
    if (box.periodic(a)) images[a] = static_cast<int>(std::ceil(cutoff / box.length(a))) + 1;
  for (std::size_t i = 0; i < target.size(); ++i) {
    std::vector<double> total(target.influence_size(), 0.0);
    for (std::size_t j = 0; j < source.size(); ++j)
      for (int x = -images[0]; x <= images[0]; ++x)
        for (int y = -images[1]; y <= images[1]; ++y)
          for (int z = -images[2]; z <= images[2]; ++z) {
            if (same && i == j && x == 0 && y == 0 && z == 0) continue;
            Q q = source[j];
            int const shift[3] = {x, y, z};
            for (int a = 0; a < box.dimension(); ++a)
              if (shift[a] != 0) q.position[a] += shift[a] * box.length(a);
            if (!(norm2(q.position - target[i].position) < cutoff * cutoff)) continue;
            auto const r = law(target[i], q);
            if constexpr (requires { r.force; }) {
              for (std::size_t c = 0; c < total.size(); ++c) total[c] += r.force[c];
              result.energy += 0.5 * r.energy;
            } else {
              for (std::size_t c = 0; c < total.size(); ++c) total[c] += reinterpret_cast<double const*>(&r)[c];
            }
          }
    result.influence.push_back(total);
  }
  return result;
}

}  // namespace boltzmann::oracle
