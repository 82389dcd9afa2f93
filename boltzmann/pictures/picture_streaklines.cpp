// Streaklines: dye released at one place, connected in order of release.
#include <boltzmann/pictures/picture_scene.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace boltzmann::pictures {
namespace {

/// A released particle.
struct Released {
  double place, release;
  double const* row;
};

Field const* number_field(AnyEnsemble const& ensemble, char const* name) {
  Field const* const field = ensemble.find_field(name);
  return field && field->components == 1 ? field : nullptr;
}

/// Sorted by place, and for each place by release.
std::vector<Released> in_order(AnyEnsemble const& ensemble) {
  std::vector<Released> all;
  int const place = number_field(ensemble, "place")->offset, release = number_field(ensemble, "release")->offset;
  for (std::size_t i = 0; i < ensemble.size(); ++i) {
    double const* const row = ensemble.row(i);
    all.push_back({row[place], row[release], row});
  }
  std::stable_sort(all.begin(), all.end(), [](Released const& a, Released const& b) {
    return std::tie(a.place, a.release) < std::tie(b.place, b.release);
  });
  return all;
}

bool is_inside(double const* row, std::vector<std::array<double, 2>> const& region, std::size_t dimension) {
  for (std::size_t a = 0; a < dimension; ++a) {
    if (!std::isfinite(row[a])) return false;
    if (a < region.size() && !(row[a] >= region[a][0] && row[a] <= region[a][1])) return false;
  }
  return true;
}

}  // namespace

bool is_dye(AnyEnsemble const& ensemble) {
  return number_field(ensemble, "place") && number_field(ensemble, "release");
}

void check_streaklines(Picture const& picture, std::vector<AnyEnsemble*> const& ensembles) {
  if (!picture.streaklines || ensembles.empty()) return;
  if (ensembles.front()->dimension() == 1) throw Error("streaklines are drawn in 2D and 3D");
  if (std::none_of(ensembles.begin(), ensembles.end(), [](AnyEnsemble const* one) { return is_dye(*one); }))
    throw Error("streaklines are of particles that remember where they were released; no ensemble is of class Dye");
}

void draw_streaklines(Canvas& canvas, Scene const& scene, std::vector<std::array<double, 2>> const& shown) {
  auto const D = static_cast<std::size_t>(scene.box().dimension());
  double longest = 0;
  for (auto const& side : shown) longest = std::max(longest, side[1] - side[0]);
  double const gap = std::isnan(scene.picture.gap) ? 0.1 * longest : scene.picture.gap;
  auto const joined = [&](Released const& a, Released const& b) {
    if (a.place != b.place || a.place < 1 || b.release - a.release != 1) return false;
    double distance = 0;
    for (std::size_t k = 0; k < D; ++k) {
      double const way = b.row[k] - a.row[k];
      auto const axis = static_cast<int>(k);
      if (scene.box().periodic(axis) && std::abs(way) > scene.box().length(axis) / 2) return false;
      distance = std::hypot(distance, way);
    }
    return distance <= gap;
  };
  for (std::size_t e = 0; e < scene.ensembles.size(); ++e) {
    if (!is_dye(*scene.ensembles[e])) continue;
    auto all = in_order(*scene.ensembles[e]);
    std::erase_if(all, [&](Released const& one) { return !is_inside(one.row, scene.picture.region, D); });
    for (std::size_t i = 0, end; i < all.size(); i = end) {
      for (end = i + 1; end < all.size() && joined(all[end - 1], all[end]);) ++end;
      Canvas::Curve line{.width = 2, .colour = scene.colour(e)};
      for (std::size_t k = i; k < end; ++k) {
        line.x.push_back(all[k].row[0]), line.y.push_back(all[k].row[1]);
        if (D == 3) line.z.push_back(all[k].row[2]);
      }
      if (end - i > 1)
        canvas.curve(std::move(line));
      else
        canvas.point({line.x[0], line.y[0], 3, line.colour, D == 3 ? line.z[0] : 0});
    }
  }
}

}  // namespace boltzmann::pictures
