// Computes limits for expansions from the moments and cores of nodes.
#include <boltzmann/schemes/multipole/acceptance.hpp>

#include <limits>

namespace boltzmann {

template <class Kind>
void AcceptanceCriterion<Kind>::start(int order, double error, std::size_t nodes) {
  order_ = order, error_ = error;
  limits_.resize(nodes);
  if constexpr (Kind::own_cores) cores_.resize(nodes);
}

template <class Kind>
void AcceptanceCriterion<Kind>::add(std::size_t number, Tree<typename Kind::Source> const& tree, double const* moments,
                                    std::size_t numbers) {
  TreeNode const& node = tree.nodes()[number];
  if constexpr (Kind::own_cores) cores_[number] = cores_of(node, tree);
  limits_[number] = limits_of(number, node.radius, moments, numbers);
}

/// Combines those of the children, or of the particles.
template <class Kind>
typename AcceptanceCriterion<Kind>::Cores AcceptanceCriterion<Kind>::cores_of(
    TreeNode const& node, Tree<typename Kind::Source> const& tree) const {
  Cores all;
  all.least = std::numeric_limits<double>::infinity();
  auto const add = [&](Cores const& part) {
    all.least = std::min(all.least, part.least);
    all.most = std::max(all.most, part.most);
    all.sum += part.sum, all.weight += part.weight;
  };
  for (std::size_t c = 0; c < node.children; ++c) add(cores_[node.child + c]);
  for (std::size_t i = node.begin; node.leaf() && i < node.end; ++i) {
    Point const& p = tree.particles()[i];
    double const square = Kind::core(law_, p) * Kind::core(law_, p);
    double weight = 0;
    for (int k = 0; k < Kind::densities; ++k) weight += std::abs(Kind::amount(p, k));
    if (weight > 0) add({square, square, weight * square, weight});
  }
  return all;
}

/// Notation: P_n the power of the moments of order n, a the radius, p the order, e the allowed error, Q the largest
/// P_n / a^n. The first order truncated from the moments contributes less than e at distances from their centre above
///   D = a ((p + 2) P_p / (e a^2))^(1/(p+3))   in 3D (2D: a (P_p / (e a))^(1/(p+2)))
/// The first order truncated from the local expansion of a node of radius b contributes less than e if the distance of
/// the sources from its centre is above
///   D = ((p + 1) Q b^p / e)^(1/(p+2))         (2D: (Q b^p / e)^(1/(p+1)))
/// All further orders together contribute 1 / (1 - a / D)^2 times that (2D: to the power 1), which margin() a includes.
/// The error of two terms of Plummer's series is less than e beyond
///   D = (10 eps^2 Q max(a, b)^2 / e)^(1/6)    (2D: (5 eps^2 Q max(a, b)^2 / e)^(1/5)),
/// and the error of a single eps for all of a node, beyond D = (3/2 (greatest eps^2 - least eps^2) Q / e)^(1/4). The
/// algebraic softening is K = -3/8 eps^4 / r^5 (2D: -1/4 eps^4 / r^4) far away, which gives
///   D = (40 eps^4 Q max(a, b)^2 / e)^(1/8)    (2D: (15 eps^4 Q max(a, b)^2 / e)^(1/7))
///   D = (15/8 (greatest eps^4 - least eps^4) Q / e)^(1/6)    (2D: ((greatest eps^4 - least eps^4) Q / e)^(1/5)).
template <class Kind>
typename AcceptanceCriterion<Kind>::Limits AcceptanceCriterion<Kind>::limits_of(std::size_t number, double a,
                                                                                double const* moments,
                                                                                std::size_t numbers) const {
  int const p = order_;
  double largest = 0, last = 0;
  for (int n = 0; n <= p; ++n) {
    double power = 0;
    for (int density = 0; density < Kind::densities; ++density) {
      double const* const m = moments + static_cast<std::size_t>(density) * numbers;
      if constexpr (D == 3)
        for (int k = 0; k <= 2 * n; ++k) power += (k > 0 ? 2 : 1) * m[n * n + k] * m[n * n + k];  // for m and -m
      else
        power += (m[2 * n] * m[2 * n] + m[2 * n + 1] * m[2 * n + 1]) * (n > 0 ? n * n : 1);
    }
    power = std::sqrt(power);
    largest = std::max(largest, power);
    if (n + 1 >= p) last = std::max(last, power);
  }
  double const e = error_;
  Limits limits;
  if constexpr (D == 3) {
    limits.source = a * (std::pow((p + 2) * last / (e * a * a), 1.0 / (p + 3)) + margin());
    limits.size = std::pow((p + 1) * largest / e, 1.0 / (p + 2));
  } else {
    limits.source = a * (std::pow(last / (e * a), 1.0 / (p + 2)) + margin());
    limits.size = std::pow(largest / e, 1.0 / (p + 1));
  }
  double least = softest2(), most = least;
  if constexpr (Kind::own_cores)
    least = std::min(cores_[number].least, cores_[number].most), most = cores_[number].most;
  limit_softening(limits, a, largest / e, softening2(number), least, most);
  return limits;
}

/// `strength`: Q / e; squares of eps: mean, least and greatest.
template <class Kind>
void AcceptanceCriterion<Kind>::limit_softening(Limits& limits, double a, double strength, double mean, double least,
                                                double most) const {
  Softening const softening = Kind::softening(law_);
  if (softening == Softening::ends) {
    limits.core = Kind::end_of_core(law_) * std::sqrt(most);
    return;
  }
  bool const plummer = softening == Softening::plummer;
  double const power = D + (plummer ? 3 : 5), factor = plummer ? (D == 3 ? 10 : 5) : (D == 3 ? 40 : 15),
               of_spread = D == 3 ? (plummer ? 1.5 : 15.0 / 8) : 1;
  auto const of = [&](double square) { return plummer ? square : square * square; };
  limits.soft = std::pow(factor * of(mean) * strength, 1 / power);
  limits.soft_size = std::pow(a, 2 / power);
  limits.spread = std::pow(of_spread * (of(most) - of(least)) * strength, 1 / (power - 2));
}

template class AcceptanceCriterion<Charges<2>>;
template class AcceptanceCriterion<Charges<3>>;
template class AcceptanceCriterion<Vortices<2>>;
template class AcceptanceCriterion<Vortices<3>>;
template class AcceptanceCriterion<VortexSlopes>;

}  // namespace boltzmann
