// Weights by name.
#include <boltzmann/core/error.hpp>
#include <boltzmann/laws/weight.hpp>

#include <algorithm>

namespace boltzmann {
namespace {

template <int D>
WeightAt at(WeightShape shape, double r, double range) {
  double const q = r / range, inverse_q = r > 0 ? range / r : 1;
  return for_weight(shape, [&](auto s) -> WeightAt {
    using Shape = decltype(s);
    double const norm = Shape::template norm<D> / (D == 1 ? range : D == 2 ? range * range : cube(range));
    return {norm * Shape::template value<D>(q), norm / square(range) * Shape::template slope<D>(q, inverse_q),
            norm / square(range) * Shape::template curvature<D>(q)};
  });
}

}  // namespace

std::string to_string(WeightShape shape) {
  return for_weight(shape, [](auto s) { return std::string(decltype(s)::name); });
}

std::vector<std::string> weight_names() { return {Lucy::name, Wendland::name, CubicSpline::name, QuinticSpline::name}; }

WeightShape weight_named(std::string_view name) {
  auto const names = weight_names();
  auto const found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    auto const close = nearest(name, names);
    throw Error("there is no weight '" + std::string(name) + "'; the weights are " + join(names) +
                (close.empty() ? "" : "; did you mean '" + close + "'?"));
  }
  return static_cast<WeightShape>(found - names.begin());
}

WeightAt weight_at(WeightShape shape, int dimension, double r, double range) {
  if (!(r < range)) return {};
  return dimension == 1 ? at<1>(shape, r, range) : dimension == 2 ? at<2>(shape, r, range) : at<3>(shape, r, range);
}

}  // namespace boltzmann
