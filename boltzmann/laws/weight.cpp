// Weights by name.
#include <boltzmann/laws/weight.hpp>

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

Words<WeightShape> const& weight_words() {
  static Words<WeightShape> const all{"weight",
                                      {{WeightShape::lucy, Lucy::name, "that of Lucy (1977) and of the sources"},
                                       {WeightShape::wendland, Wendland::name, "Wendland's C2 function"},
                                       {WeightShape::cubic_spline, CubicSpline::name, "the cubic B-spline"},
                                       {WeightShape::quintic_spline, QuinticSpline::name, "the quintic B-spline"}}};
  return all;
}
std::string to_string(WeightShape shape) { return weight_words().name(shape); }

WeightAt weight_at(WeightShape shape, int dimension, double r, double range) {
  if (!(r < range)) return {};
  return dimension == 1 ? at<1>(shape, r, range) : dimension == 2 ? at<2>(shape, r, range) : at<3>(shape, r, range);
}

}  // namespace boltzmann
