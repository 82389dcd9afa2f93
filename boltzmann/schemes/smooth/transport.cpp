// Viscosity and conduction: selection of their passes, and their contribution to the stress.
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/schemes/smooth/loaded.hpp>
#include <boltzmann/schemes/smooth/transport_passes.hpp>

namespace boltzmann {

using namespace detail;

/// Computes the local motion of each particle, into the blocks of transport.
void SmoothScheme::find_motion(Recipe const& recipe, SortedCopy& copy) {
  std::size_t const first = copy.blocks() + 1, last = first + transport_blocks(box().dimension());
  std::size_t const components =
      in_dimension(box().dimension(), [](auto d) { return sizeof(MotionSum<d, double>) / sizeof(double); });
  run_pass(recipe.transport_passes->motion, components, sums_);
  for (auto& loaded : loaded_) loaded->task.motion = sums_.data();
  run_material(&MaterialKernels::motion);
  if (division_) bring(copy, first, last);
  copy.refresh_images(first, last, threads_for(copy.owned(), 1, threads()));
}

void SmoothScheme::add_transport(Recipe const& recipe) {
  std::size_t const components = static_cast<std::size_t>(box().dimension()) + 1;
  run_pass(recipe.transport_passes->rates, components, sums_);
  for (auto& loaded : loaded_) loaded->task.rates = sums_.data();
  run_material(&MaterialKernels::transport);
}

/// The virial of viscous forces: minus half of r_a F_b for each particle of a pair, xx, xy, xz, yy, ... at 3 a + b.
void SmoothScheme::add_viscous_stress(Recipe const& recipe, std::array<ExactSum, 9>& sums) {
  auto const D = static_cast<std::size_t>(box().dimension()), components = D * (D + 1) / 2;
  run_pass(recipe.transport_passes->stress, components, sums_);
  SortedCopy const& copy = hood_->copy(*points_);
  std::size_t const block = copy.blocks() + 1;  // starts with the volume
  hood_->over_own(copy, copy.owned(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      double const* found = sums_.data() + components * k;
      double const volume = copy.block(block)[row_block * k];
      for (std::size_t a = 0; a < D; ++a)
        for (std::size_t b = a; b < D; ++b) sums[3 * a + b] += -0.5 * volume * *found++;
    }
  });
}

}  // namespace boltzmann
