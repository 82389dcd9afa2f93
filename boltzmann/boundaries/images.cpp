// Maps of a particle's numbers beyond walls.
#include <boltzmann/boundaries/images.hpp>

#include <cmath>
#include <optional>

namespace boltzmann {
namespace {

/// The value about which a number is odd at this wall; none: it is even there.
std::optional<double> odd_about(Box const& box, ImageComponent of, int axis, Box::End end) {
  Wall const& wall = box.wall(axis, end);
  bool const along_normal = axis == of.axis;
  auto const sign_changes = [](bool changes) { return changes ? std::optional(-0.0) : std::nullopt; };
  switch (of.rule) {
    case ImageRule::same:
      return {};
    case ImageRule::position:
      if (!along_normal) return {};
      return end == Box::End::low ? box.low(axis) : box.high(axis);
    case ImageRule::velocity:
      if (!along_normal && wall.slips) return {};
      return box.wall_velocity(axis, end, of.axis);
    case ImageRule::displacement:
      return sign_changes(along_normal || !wall.slips);
    case ImageRule::temperature:
      if (std::isnan(wall.temperature)) return {};
      return wall.temperature;
    case ImageRule::normal_vector:
      return sign_changes(along_normal);
    case ImageRule::heat_flux:
      return sign_changes(along_normal == std::isnan(wall.temperature));
    case ImageRule::tensor:
      return sign_changes(wall.slips && along_normal != (axis == of.axis2));
  }
  return {};
}

}  // namespace

// Odd at walls at w0, w1, ...: x -> 2 w0 - x -> 2 w1 - (2 w0 - x) ...; the mean over all orders, which equals each of
// them if the walls agree. An even number of walls leaves x unchanged, an odd number reflects it about the mean of the
// walls.
ImageMap image_map(Box const& box, ImageComponent component, Turns const& turns) {
  return image_map(box, component, turns, box.whole_slide());
}

ImageMap image_map(Box const& box, ImageComponent component, Turns const& turns, double whole_slide) {
  int const c = component.axis;
  int const slides = box.sheared() && c == box.shear().flow ? turns[box.shear().gradient] : 0;
  if (slides != 0 && component.rule == ImageRule::velocity) return {1, slides * box.slide_velocity()};
  if (component.rule == ImageRule::position && box.periodic(c)) {
    if (slides != 0) return {1, turns[c] * box.length(c) + slides * (box.slide() - whole_slide)};
    return turns[c] == 0 ? ImageMap{} : ImageMap{1, turns[c] * box.length(c)};
  }
  double sum = -0.0;
  int walls = 0;
  for (int a = 0; a < box.dimension(); ++a) {
    if (turns[a] == 0 || box.periodic(a)) continue;
    auto const about = odd_about(box, component, a, turns[a] < 0 ? Box::End::low : Box::End::high);
    if (about) sum += *about, ++walls;
  }
  return walls % 2 == 0 ? ImageMap{} : ImageMap{-1, 2 * sum / walls};
}

int Images::most(int axis, double reach) const {
  if (box_->sheared() && axis == box_->shear().flow)
    return static_cast<int>(
        std::ceil(reach / (edges_[3 + axis] - edges_[axis]) + 0.5 * most(box_->shear().gradient, reach) + 1e-9));
  if (box_->periodic(axis)) return static_cast<int>(std::ceil(reach / (edges_[3 + axis] - edges_[axis])));
  return box_->boundary(axis) == Boundary::mirror ? 1 : 0;
}

bool Images::exists(Turns const& turns, double reach) const {
  for (int a = 0; a < 3; ++a) {
    if (turns[a] == 0) continue;
    if (a >= box_->dimension() || std::abs(turns[a]) > most(a, reach)) return false;
    if (!box_->periodic(a) && !mirrors(a, turns[a] < 0 ? Box::End::low : Box::End::high)) return false;
  }
  return true;
}

}  // namespace boltzmann
