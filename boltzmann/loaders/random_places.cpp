// Finds a place for the next particle.
#include <boltzmann/loaders/random_places.hpp>

#include <algorithm>
#include <cmath>

namespace boltzmann {

PlacedParticles::PlacedParticles(AnyEnsemble const& ensemble, Box const& box, double distance)
    : ensemble_(ensemble), box_(box), distance2_(distance * distance), next_(ensemble.size(), nobody) {
  double const most =
      std::max(1.0, std::floor(std::pow(2.0 * static_cast<double>(ensemble.size()) + 1.0, 1.0 / ensemble.dimension())));
  std::size_t total = 1;
  for (int a = 0; a < box.dimension(); ++a) {
    cells_[a] = static_cast<std::size_t>(std::clamp(std::floor(box.length(a) / distance), 1.0, most));
    total *= cells_[a];
  }
  first_.assign(total, nobody);
}

/// True if f is true for the position of a particle in the cells around x.
template <class F>
bool PlacedParticles::any_near(double const* x, F const& f) const {
  std::array<std::array<std::size_t, 3>, 3> near{};
  std::array<std::size_t, 3> count{1, 1, 1};
  for (int a = 0; a < box_.dimension(); ++a) {
    std::size_t const here = cell(a, x[a]), last = cells_[a] - 1;
    count[a] = 0;
    auto const look = [&](std::size_t c) {
      for (std::size_t k = 0; k < count[a]; ++k)
        if (near[a][k] == c) return;
      near[a][count[a]++] = c;
    };
    look(here);
    if (here > 0 || box_.periodic(a)) look(here > 0 ? here - 1 : last);
    if (here < last || box_.periodic(a)) look(here < last ? here + 1 : 0);
  }
  for (std::size_t k2 = 0; k2 < count[2]; ++k2)
    for (std::size_t k1 = 0; k1 < count[1]; ++k1)
      for (std::size_t k0 = 0; k0 < count[0]; ++k0)
        for (std::size_t j = first_[(near[2][k2] * cells_[1] + near[1][k1]) * cells_[0] + near[0][k0]]; j != nobody;
             j = next_[j])
          if (f(ensemble_.row(j))) return true;
  return false;
}

bool PlacedParticles::free(double const* x) const {
  return !any_near(x, [&](double const* y) { return furthest2(x, y, {0, 0, 0}) < distance2_; });
}

bool PlacedParticles::covers(double const* x, std::array<double, 3> const& half_edges) const {
  return any_near(x, [&](double const* y) { return furthest2(x, y, half_edges) < distance2_; });
}

void PlacedParticles::add(std::size_t i) {
  double const* x = ensemble_.row(i);
  std::array<std::size_t, 3> at{0, 0, 0};
  for (int a = 0; a < box_.dimension(); ++a) at[a] = cell(a, x[a]);
  std::size_t& first = first_[(at[2] * cells_[1] + at[1]) * cells_[0] + at[0]];
  next_[i] = first;
  first = i;
}

std::size_t PlacedParticles::cell(int a, double x) const {
  double const c = std::floor((x - box_.low(a)) / box_.length(a) * static_cast<double>(cells_[a]));
  return static_cast<std::size_t>(std::clamp(c, 0.0, static_cast<double>(cells_[a] - 1)));
}

double PlacedParticles::furthest2(double const* x, double const* y, std::array<double, 3> const& half_edges) const {
  std::array<double, 3> d{0, 0, 0};
  for (int a = 0; a < box_.dimension(); ++a) d[a] = x[a] - y[a];
  box_.nearest_image(d.data());
  for (std::size_t a = 0; a < 3; ++a) d[a] = std::abs(d[a]) + half_edges[a];
  return d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
}

FreeBlocks::FreeBlocks(Box const& box, PlacedParticles const& placed, double distance, std::size_t particles)
    : box_(box), placed_(placed), max_blocks_(10'000 + 30 * particles) {
  double total = 1;
  for (int a = 0; a < box.dimension(); ++a) total *= std::ceil(2 * box.length(a) / distance);
  double const coarser = std::max(1.0, std::pow(2 * total / static_cast<double>(max_blocks_), 1.0 / box.dimension()));
  std::array<std::size_t, 3> count{1, 1, 1};
  for (int a = 0; a < box.dimension(); ++a) {
    count[a] = static_cast<std::size_t>(std::ceil(2 * box.length(a) / (distance * coarser)));
    half_edges_[a] = 0.5 * box.length(a) / static_cast<double>(count[a]);
  }
  std::array<std::size_t, 3> k{0, 0, 0};
  for (k[2] = 0; k[2] < count[2]; ++k[2])
    for (k[1] = 0; k[1] < count[1]; ++k[1])
      for (k[0] = 0; k[0] < count[0]; ++k[0]) {
        Block middle{0, 0, 0};
        for (int a = 0; a < box.dimension(); ++a)
          middle[a] = box.low(a) + (2 * static_cast<double>(k[a]) + 1) * half_edges_[a];
        if (!placed.covers(middle.data(), half_edges_)) blocks_.push_back(middle);
      }
}

bool FreeBlocks::draw(Stream& stream, std::function<bool(double const*)> const& there, double* x) {
  while (!blocks_.empty() && blocks_.size() <= max_blocks_) {
    auto const k = static_cast<std::size_t>(stream.uniform() * static_cast<double>(blocks_.size()));
    for (int a = 0; a < box_.dimension(); ++a)
      x[a] = std::clamp(blocks_[k][a] + half_edges_[a] * (2 * stream.uniform() - 1), box_.low(a),
                        std::nextafter(box_.high(a), box_.low(a)));
    if (there(x) && placed_.free(x)) return true;
    if (++missed_ > blocks_.size()) halve();
  }
  return false;
}

void FreeBlocks::halve() {
  missed_ = 0;
  for (double& half : half_edges_) half *= 0.5;
  std::vector<Block> parts;
  int const corners = 1 << box_.dimension();
  for (auto const& block : blocks_)
    for (int corner = 0; corner < corners; ++corner) {
      Block middle = block;
      for (int a = 0; a < box_.dimension(); ++a) middle[a] += (corner >> a & 1 ? 1 : -1) * half_edges_[a];
      if (!placed_.covers(middle.data(), half_edges_)) parts.push_back(middle);
    }
  blocks_ = std::move(parts);
}

double saturation(int dimension) { return dimension == 1 ? 0.7476 : dimension == 2 ? 0.547 : 0.384; }

double ball_volume(int dimension, double diameter) {
  return dimension == 1   ? diameter
         : dimension == 2 ? pi / 4 * diameter * diameter
                          : pi / 6 * diameter * diameter * diameter;
}

}  // namespace boltzmann
