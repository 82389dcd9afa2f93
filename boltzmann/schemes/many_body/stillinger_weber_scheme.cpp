// The answer of an atom with bonds is its sums (bonded_passes.hpp).
#include <boltzmann/core/kernel_dispatch.hpp>
#include <boltzmann/schemes/many_body/atom_point.hpp>
#include <boltzmann/schemes/many_body/stillinger_weber_scheme.hpp>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

StillingerWeber const& checked(StillingerWeber const& law) {
  law.check();
  return law;
}

std::unique_ptr<AnyEnsemble> bonded_points(int dimension) {
  constexpr auto name = "atoms with bonds";
  if (dimension == 1) return std::make_unique<Ensemble<EmbeddedPoint<1>>>(name);
  if (dimension == 2) return std::make_unique<Ensemble<EmbeddedPoint<2>>>(name);
  return std::make_unique<Ensemble<EmbeddedPoint<3>>>(name);
}

/// The size of sum g, sum g u and the upper half of sum g u u.
std::size_t answers_in(std::size_t D) { return 1 + D + D * (D + 1) / 2; }

}  // namespace

StillingerWeberScheme::StillingerWeberScheme(Box box, StillingerWeber const& law)
    : ManyBodyScheme(box, checked(law).cutoff(), bonded_points(box.dimension()),
                     (box.dimension() + answers_in(static_cast<std::size_t>(box.dimension())) - 1) / row_block),
      law_(law) {}

ManyBodyScheme::Passes StillingerWeberScheme::passes() const {
  auto const& table = for_instruction_set(
      [](auto set) -> ManyBodyKernelTable const& { return many_body_kernels<decltype(set)::value>(); });
  auto const D = static_cast<std::size_t>(box().dimension());
  Passes passes;
  passes.kernels = table.bonded[D - 1];
  passes.law = &law_;
  passes.answers = answers_in(D);
  passes.sums = passes.answers + 1;
  passes.first = D;
  passes.sum_quantum = std::ldexp(1.0, -44);  // weights are below 1
  return passes;
}

void StillingerWeberScheme::answer(Atoms const& atoms) const {
  auto const D = static_cast<std::size_t>(box().dimension());
  std::size_t const answers = answers_in(D), sums = answers + 1;
  double const c = law_.cosine;
  for (std::size_t k = 0; k < atoms.size; ++k) {
    double const* const sum = atoms.sums + sums * k;
    std::copy_n(sum, answers, atoms.answers + answers * k);
    if (!atoms.energies) continue;
    double const* const lean = sum + 1;
    double const* spread = lean + D;
    double bends = c * c * sum[0] * sum[0] - (1 - c) * (1 - c) * sum[answers];
    for (std::size_t a = 0; a < D; ++a) bends -= 2 * c * lean[a] * lean[a];
    for (std::size_t a = 0; a < D; ++a)
      for (std::size_t b = a; b < D; ++b, ++spread) bends += (a == b ? 1 : 2) * *spread * *spread;
    atoms.energies[k] = 0.5 * law_.lambda * law_.epsilon * bends;
  }
}

double StillingerWeberScheme::length_scale(AnyEnsemble const& ensemble) const {
  return supervises(ensemble) ? law_.sigma : __builtin_inf();
}

}  // namespace boltzmann
