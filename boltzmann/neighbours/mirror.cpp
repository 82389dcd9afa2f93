// Sorting, periodic images, and following the particles between two builds.
#include <boltzmann/neighbours/mirror.hpp>

#include <boltzmann/core/error.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/neighbours/cells.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace boltzmann {
namespace {

constexpr std::size_t refresh_grain = 4096;

[[noreturn]] void not_finite(AnyEnsemble const& ensemble, std::size_t particle) {
  throw PhysicsFailure(
      fmt::format("particle {} of '{}' is at a position that is not finite", particle, ensemble.name()));
}

}  // namespace

void Mirror::build(double reach) {
  int const dimension = box_->dimension();
  std::vector<double> positions(ensemble_->size() * dimension);
  for (std::size_t i = 0; i < ensemble_->size(); ++i)
    for (int a = 0; a < dimension; ++a) {
      double x = ensemble_->row(i)[a];
      if (!std::isfinite(x)) not_finite(*ensemble_, i);
      if (box_->periodic(a)) {
        double const length = box_->length(a), low = box_->low(a);
        if (x < low || x >= low + length) x -= length * std::floor((x - low) / length);
      }
      positions[i * dimension + a] = x;
    }
  rebuild(reach, positions);
}

void Mirror::rebuild(double reach, std::span<double const> reference) {
  reference_.assign(reference.begin(), reference.end());
  sort(reach);
  rows_.assign(owned() * stride(), 0.0);
  int const dimension = box_->dimension();
  for (std::size_t k = 0; k < owned(); ++k)
    std::copy_n(reference_.data() + static_cast<std::size_t>(order_[k]) * dimension, dimension,
                rows_.data() + k * stride());
  add_ghosts(reach);
}

void Mirror::sort(double reach) {
  int const dimension = box_->dimension();
  order_ = Cells(dimension, reference_.data(), dimension, ensemble_->size(), reach).items();
}

void Mirror::add_ghosts(double reach) {
  ghosts_.clear();
  for (int a = 0; a < box_->dimension(); ++a) {
    if (!box_->periodic(a)) continue;
    double const length = box_->length(a), low = box_->low(a), high = box_->high(a);
    int const images = static_cast<int>(std::ceil(reach / length));
    std::size_t const present = total();
    rows_.resize(present * stride());
    for (std::size_t k = 0; k < present; ++k)
      for (int n = -images; n <= images; ++n) {
        double const x = rows_[k * stride() + a] + n * length;
        if (n != 0 && x >= low - reach && x <= high + reach) {
          ghosts_.push_back({static_cast<std::uint32_t>(k), a, n * length});
          rows_.resize(rows_.size() + stride());
          std::copy_n(rows_.data() + k * stride(), box_->dimension(), rows_.data() + rows_.size() - stride());
          rows_[rows_.size() - stride() + a] = x;
        }
      }
  }
  rows_.resize((total() + 1) * stride());
  for (std::size_t k = 0; k < stride(); ++k) rows_[total() * stride() + k] = std::numeric_limits<double>::quiet_NaN();
}

Displacements Mirror::refresh(int threads) {
  int const dimension = box_->dimension();
  std::size_t const stride = this->stride();
  std::vector<Displacements> parts((owned() + refresh_grain - 1) / refresh_grain + 1);
  for_ranges(owned(), refresh_grain, threads, [&](std::size_t begin, std::size_t end) {
    Displacements part;
    for (std::size_t k = begin; k < end; ++k) {
      std::size_t const particle = order_[k];
      double* to = rows_.data() + k * stride;
      std::memcpy(to, ensemble_->row(particle), stride * sizeof(double));
      double const* reference = reference_.data() + particle * dimension;
      double square = 0;
      for (int a = 0; a < dimension; ++a) {
        double moved = to[a] - reference[a];
        if (box_->periodic(a)) {
          double const shift = box_->length(a) * std::nearbyint(moved / box_->length(a));
          to[a] -= shift;
          moved -= shift;
        }
        square += moved * moved;
      }
      if (!(square < std::numeric_limits<double>::infinity())) not_finite(*ensemble_, particle);
      part.take(square);
    }
    parts[begin / refresh_grain] = part;
  });
  move_ghosts();
  Displacements all;
  for (auto const& part : parts) {
    all.take(part.largest);
    all.take(part.second);
  }
  return all;
}

void Mirror::move_ghosts() {
  std::size_t const stride = this->stride();
  for (std::size_t g = 0; g < ghosts_.size(); ++g) {
    Ghost const& ghost = ghosts_[g];
    double* to = rows_.data() + (owned() + g) * stride;
    std::memcpy(to, rows_.data() + ghost.source * stride, stride * sizeof(double));
    to[ghost.axis] += ghost.shift;
  }
}

}  // namespace boltzmann
