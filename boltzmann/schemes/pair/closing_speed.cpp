// Mean and thermal velocities of two ensembles, and the walls that they approach.
#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/schemes/pair/closing_speed.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace boltzmann {
namespace {

struct Motion {
  std::array<double, 3> mean{};
  double thermal = 0;  // the largest over the axes
};

Motion motion_of(AnyEnsemble const& ensemble, Field const& velocity) {
  Motion motion;
  auto const count = static_cast<double>(ensemble.size());
  for (int a = 0; a < velocity.components && a < 3 && count > 0; ++a) {
    auto const value = [&, at = velocity.offset + a](std::size_t i) { return ensemble.row(i)[at]; };
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < ensemble.size(); ++i) sum += value(i);
    double const mean = sum / count;
    for (std::size_t i = 0; i < ensemble.size(); ++i) squares += (value(i) - mean) * (value(i) - mean);
    motion.mean[a] = mean;
    motion.thermal = std::max(motion.thermal, std::sqrt(squares / count));
  }
  return motion;
}

double approach_to_walls(Box const& box, Motion const& motion) {
  double fastest = 0;
  for (int a = 0; a < box.dimension(); ++a)
    for (Box::End const end : {Box::End::low, Box::End::high})
      if (box.walled(a, end)) {
        double const towards = box.wall(a, end).velocity[a] - motion.mean[a];
        fastest = std::max(fastest, end == Box::End::low ? towards : -towards);
      }
  return fastest;
}

}  // namespace

double closing_speed(Box const& box, AnyEnsemble const& a, AnyEnsemble const& b) {
  Field const *of_a = a.find_field("velocity"), *of_b = b.find_field("velocity");
  if (of_a == nullptr || of_b == nullptr) return 0;
  Motion const first = motion_of(a, *of_a), second = &a == &b ? first : motion_of(b, *of_b);
  double const drift =
      std::hypot(first.mean[0] - second.mean[0], first.mean[1] - second.mean[1], first.mean[2] - second.mean[2]);
  double const reflected = 2 * std::max(approach_to_walls(box, first), approach_to_walls(box, second));
  return std::max(drift, reflected) + 3 * std::max(first.thermal, second.thermal);
}

}  // namespace boltzmann
