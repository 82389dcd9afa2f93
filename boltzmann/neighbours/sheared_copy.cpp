// The sorted copy of a sheared box: rows stay near references that move with the flow, however the box has wrapped
// their particles.
#include <boltzmann/neighbours/sorted_copy.hpp>

#include <cmath>

namespace boltzmann {

/// The strain of the flow since the build.
double SortedCopy::strain() const { return (box_->slide() - built_slide_) / box_->length(box_->shear().gradient); }

/// The image of a position that is nearest to the reference of row k as moved by the flow, and its distance from there.
SortedCopy::Placed SortedCopy::placed(std::size_t k, double const* position) const {
  double const* const reference = references_.data() + 4 * k;
  int const f = box_->shear().flow, g = box_->shear().gradient;
  Placed at;
  for (int a = 0; a < box_->dimension(); ++a) at.position[a] = position[a];
  at.ups = std::nearbyint((reference[g] - position[g]) / box_->length(g));
  at.position[g] += at.ups * box_->length(g);
  at.position[f] += at.ups * (box_->slide() - box_->whole_slide(built_slide_));
  double const middle = 0.5 * (box_->low(g) + box_->high(g));
  for (int a = 0; a < box_->dimension(); ++a) {
    double const flowed = a == f ? strain() * (reference[g] - middle) : 0;
    double moved = at.position[a] - (reference[a] + flowed);
    if (a != g && box_->periodic(a)) {
      double const turns = std::nearbyint(moved / box_->length(a));
      at.position[a] -= turns * box_->length(a);
      moved = at.position[a] - (reference[a] + flowed);
    }
    at.moved2 += moved * moved;
  }
  return at;
}

/// Moves row k there, with the velocity of that image.
void SortedCopy::place(std::size_t k, Placed const& placed) {
  int const f = box_->shear().flow;
  for (int a = 0; a < box_->dimension(); ++a) rows_[row_block * k + a] = placed.position[a];
  ups_[k] += placed.ups;
  if (placed.ups == 0) return;
  for (std::size_t n = 0; n < row_block * blocks(); ++n)
    if (components_[n].rule == ImageRule::velocity && components_[n].axis == f)
      block(n / row_block)[row_block * k + n % row_block] += placed.ups * box_->slide_velocity();
}

Refreshed SortedCopy::refresh_sheared(RefreshTask const& task, std::size_t begin, std::size_t end) {
  Refreshed result;
  for (std::size_t k = begin; k < end; ++k) {
    double const* const from = task.ensemble + task.order[k] * task.stride;
    double* const row = task.copy + row_block * k;
    std::array<double, 3> before{};
    for (int a = 0; a < task.dimension; ++a) before[a] = row[a];
    for (std::size_t c = 0; c < task.stride; ++c) row[c / row_block * task.block_stride + c % row_block] = from[c];
    ups_[k] = 0;
    Placed const now = placed(k, from);
    place(k, now);
    result.finite = result.finite && now.moved2 < __builtin_inf();
    if (now.moved2 > result.largest2) result.largest2 = now.moved2;
    if (now.position != before) result.changed = true;
  }
  return result;
}

bool SortedCopy::is_current_in_shear() const {
  if (box_->slide() != slide_) return false;
  for (auto const& [begin, end] : pieces_)
    for (std::size_t k = begin; k < end; ++k) {
      auto const now = placed(k, ensemble_->row(order_[k])).position;
      for (int a = 0; a < box_->dimension(); ++a)
        if (now[a] != rows_[row_block * k + a]) return false;
    }
  return true;
}

/// Wraps a reference into the box at this slide of the images.
void SortedCopy::wrap_reference(double* reference, double slide) const {
  int const f = box_->shear().flow, g = box_->shear().gradient;
  double const before = reference[g];
  reference[g] = box_->wrapped(before, g);
  reference[f] += slide * std::nearbyint((reference[g] - before) / box_->length(g));
  for (int a = 0; a < box_->dimension(); ++a)
    if (a != g && box_->periodic(a)) reference[a] = box_->wrapped(reference[a], a);
}

/// The position at the build of a particle that is here now, if only the flow had moved it since.
void SortedCopy::put_back_to_build(double const* position, double* reference) const {
  int const f = box_->shear().flow, g = box_->shear().gradient;
  for (int a = 0; a < box_->dimension(); ++a) reference[a] = position[a];
  reference[f] -= strain() * (position[g] - 0.5 * (box_->low(g) + box_->high(g)));
  wrap_reference(reference, built_slide_ - box_->whole_slide(built_slide_));
}

double SortedCopy::ahead_in_flow(std::size_t k) const {
  double const up = k < owned() ? 0 : turns_[ghost_turns_[k - owned() - 1]][box_->shear().gradient];
  return (ups_[owner(k)] + up) * box_->slide_velocity();
}

}  // namespace boltzmann
