// Projects marks, sorts them by depth, and draws the box around them.
#include <boltzmann/pictures/canvas_ticks.hpp>
#include <boltzmann/pictures/projection.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

namespace boltzmann {
namespace {

using Box3 = std::array<std::array<double, 2>, 3>;
using Place = Projection::Place;

// A projection with its sines and cosines.
class View {
 public:
  explicit View(Projection const& from) {
    double const a = from.azimuth * std::numbers::pi / 180, e = from.elevation * std::numbers::pi / 180;
    cos_a_ = std::cos(a), sin_a_ = std::sin(a), cos_e_ = std::cos(e), sin_e_ = std::sin(e);
  }
  Place operator()(double x, double y, double z) const {
    double const out = x * cos_a_ + y * sin_a_;
    return {y * cos_a_ - x * sin_a_, z * cos_e_ - out * sin_e_, out * cos_e_ + z * sin_e_};
  }

 private:
  double cos_a_, sin_a_, cos_e_, sin_e_;
};

struct Interval {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void add(double v) {
    if (!std::isfinite(v)) return;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  double width() const { return low > high ? 0 : high - low; }
};

// Calls with (k, x, y, z) for every particle of a cloud.
template <class Visit>
void each_particle(Canvas::Cloud const& cloud, Visit visit) {
  auto const dimension = static_cast<std::size_t>(cloud.dimension);
  for (std::size_t k = 0; k < cloud.count(); ++k) {
    auto const at = [&](std::size_t a) {
      return cloud.origin[a] + cloud.scale[a] * static_cast<double>(cloud.position[dimension * k + a]);
    };
    visit(k, at(0), at(1), dimension == 3 ? at(2) : 0.0);
  }
}

template <class Visit>
void each_place_of(Canvas const& space, Visit visit) {
  for (auto const& c : space.circles()) visit(c.x, c.y, c.z);
  for (auto const& p : space.points()) visit(p.x, p.y, p.z);
  for (auto const& l : space.lines()) visit(l.x0, l.y0, l.z0), visit(l.x1, l.y1, l.z1);
  for (auto const& a : space.arrows()) visit(a.x0, a.y0, a.z0), visit(a.x1, a.y1, a.z1);
  for (auto const& t : space.texts()) visit(t.x, t.y, t.z);
  for (auto const& c : space.curves())
    for (std::size_t i = 0; i < c.x.size(); ++i) visit(c.x[i], c.y[i], c.z.empty() ? 0.0 : c.z[i]);
  for (auto const& cloud : space.clouds())
    each_particle(cloud, [&](std::size_t, double x, double y, double z) { visit(x, y, z); });
}

// The outline of a box: edges behind the content first, the three edges at the nearest corner last. Names and ticks are
// along three edges of the silhouette.
class BoxOutline {
 public:
  BoxOutline(Box3 const& box, std::array<Axis const*, 3> const& axes, View const& view)
      : box_(box), axes_(axes), view_(view) {
    for (int corner = 1; corner < 8; ++corner) {
      if (at(corner).near > at(nearest_).near) nearest_ = corner;
      if (at(corner).near < at(farthest_).near) farthest_ = corner;
    }
    for (int corner = 0; corner < 8; ++corner) {
      right_.add(at(corner).right);
      up_.add(at(corner).up);
    }
  }

  void draw_behind(Canvas& canvas) const {
    each_edge([&](int a, int b, int) {
      bool const hidden = a == farthest_ || b == farthest_;
      if (a != nearest_ && b != nearest_) edge(canvas, a, b, hidden ? 0.22 : 0.5);
    });
  }
  void draw_before(Canvas& canvas) const {
    each_edge([&](int a, int b, int) {
      if (a == nearest_ || b == nearest_) edge(canvas, a, b, 0.22);
    });
  }

  void name_axes(Canvas& canvas) const {
    double const size = std::max(right_.width(), up_.width());
    for (int axis = 0; axis < 3; ++axis) {
      auto const edge = named_edge(axis);
      if (!edge) continue;
      auto const& [a, b, out_right, out_up] = *edge;
      auto write = [&, a = a, b = b, out_right = out_right, out_up = out_up](double fraction, double away,
                                                                             std::string const& text, float font) {
        double const align = 0.5 - 0.5 * std::clamp(4 * out_right, -1.0, 1.0);
        canvas.text(a.right + fraction * (b.right - a.right) + away * size * out_right,
                    a.up + fraction * (b.up - a.up) + away * size * out_up, text, ink, font, align);
      };
      auto const along = static_cast<std::size_t>(axis);
      double const factor = axes_[along]->factor, low = box_[along][0], width = box_[along][1] - low;
      Ticks const ticks = ticks_between(low * factor, box_[along][1] * factor, false, 5);
      for (std::size_t i = 0; i < ticks.major.size(); ++i) {
        double const fraction = (ticks.major[i] / factor - low) / width;
        double const r = a.right + fraction * (b.right - a.right), u = a.up + fraction * (b.up - a.up);
        canvas.line(r, u, r + 0.009 * size * out_right, u + 0.009 * size * out_up, with_alpha(ink, 0.6), 1.3F);
        write(fraction, 0.028, ticks.labels[i], 18);
      }
      std::string unit = axes_[along]->unit;
      if (!ticks.multiplier.empty()) unit.insert(0, unit.empty() ? ticks.multiplier : ticks.multiplier + " ");
      std::string const& label = axes_[along]->label;
      std::string const name = unit.empty() ? label : label.empty() ? "(" + unit + ")" : label + " (" + unit + ")";
      if (is_named_above(axis, *edge)) {  // above the edge it needs no extra margin
        auto const& top = a.up > b.up ? a : b;
        canvas.text(top.right, top.up + 0.04 * size, name, ink, 21, axis == 2 ? 0.85 : 0.5);
      } else {
        write(0.5, name_distance, name, 21);
      }
    }
  }

  // The range of the picture, with space for the names.
  std::array<Interval, 2> ranges() const {
    double const size = std::max(right_.width(), up_.width());
    std::array<Interval, 2> both = {right_, up_};
    both[0].low -= 0.1 * size;
    both[0].high += 0.07 * size;
    both[1].low -= 0.07 * size;
    both[1].high += 0.07 * size;
    for (int axis = 0; axis < 3; ++axis)  // a name below a horizontal edge
      if (auto const edge = named_edge(axis); edge && !is_named_above(axis, *edge))
        both[1].low = std::min(
            both[1].low, (edge->a.up + edge->b.up) / 2 + (name_distance * std::min(edge->out_up, 0.0) - 0.025) * size);
    return both;
  }

 private:
  static constexpr double name_distance = 0.09;  // from its edge, as a fraction of the picture
  struct NamedEdge {
    Place a, b;
    double out_right, out_up;  // direction across the edge, away from the box
  };
  /// The silhouette's edges along an axis are those without the nearest and farthest corner. The names of x and y are
  /// at the lower of them, that of z at the left one. Nothing if the axis is parallel to the direction of view.
  std::optional<NamedEdge> named_edge(int axis) const {
    double const size = std::max(right_.width(), up_.width());
    int best_a = -1, best_b = -1;
    double best = std::numeric_limits<double>::infinity();
    each_edge([&](int a, int b, int along) {
      if (along != axis || a == nearest_ || b == nearest_ || a == farthest_ || b == farthest_) return;
      double const rank = axis == 2 ? at(a).right + at(b).right : at(a).up + at(b).up;
      if (rank < best - 1e-12 * size) {
        best = rank;
        best_a = a;
        best_b = b;
      }
    });
    if (best_a < 0) return std::nullopt;
    auto const a = at(best_a), b = at(best_b);
    double const length = std::hypot(b.right - a.right, b.up - a.up);
    if (!(length >= 0.1 * size && length > 0)) return std::nullopt;
    NamedEdge edge{a, b, (b.up - a.up) / length, -(b.right - a.right) / length};
    double const mid_right = (a.right + b.right) / 2, mid_up = (a.up + b.up) / 2;
    if (edge.out_right * (mid_right - (right_.low + right_.high) / 2) +
            edge.out_up * (mid_up - (up_.low + up_.high) / 2) <
        0) {
      edge.out_right = -edge.out_right;
      edge.out_up = -edge.out_up;
    }
    return edge;
  }
  /// The name of z, or of a nearly vertical axis, is above its upper end.
  static bool is_named_above(int axis, NamedEdge const& edge) { return axis == 2 || std::abs(edge.out_right) > 0.85; }

  Place at(int corner) const {
    auto side = [&](int axis) {
      return box_[static_cast<std::size_t>(axis)][static_cast<std::size_t>(corner >> axis & 1)];
    };
    return view_(side(0), side(1), side(2));
  }
  template <class Visit>
  static void each_edge(Visit visit) {
    for (int axis = 0; axis < 3; ++axis)
      for (int corner = 0; corner < 8; ++corner)
        if ((corner >> axis & 1) == 0) visit(corner, corner | 1 << axis, axis);
  }
  void edge(Canvas& canvas, int a, int b, double strength) const {
    auto const from = at(a), to = at(b);
    canvas.line(from.right, from.up, to.right, to.up, with_alpha(ink, strength), 1.4F);
  }

  Box3 const& box_;
  std::array<Axis const*, 3> const& axes_;
  View const& view_;
  int nearest_ = 0, farthest_ = 0;
  Interval right_, up_;
};

// All discs of a space, from far to near.
class Discs {
 public:
  // `screen`: the longer side of the picture; sizes in pixels are converted to fractions of it.
  Discs(Canvas const& space, View const& view, double screen) : view_(view) {
    for (auto const& run : space.order())
      for (std::size_t i = run.first; i < run.first + run.count; ++i) {
        if (run.kind == Canvas::Kind::circle) add(space.circles()[i]);
        if (run.kind == Canvas::Kind::point) add(space.points()[i]);
        if (run.kind == Canvas::Kind::cloud) add(space.clouds()[i], screen);
      }
  }

  void draw(Canvas& canvas) const {
    std::vector<std::size_t> order(discs_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t i, std::size_t j) { return discs_[i].near < discs_[j].near; });
    for (std::size_t const i : order) {
      auto const& disc = discs_[i];
      if (disc.is_point) {
        canvas.point(disc.mark.x, disc.mark.y, disc.mark.colour, static_cast<float>(disc.mark.radius));
        continue;
      }
      Canvas::Circle mark = disc.mark;
      mark.depth = depth_.width() > 0 ? static_cast<float>(disc.fade * (depth_.high - disc.near) / depth_.width()) : 0;
      canvas.circle(mark);
    }
  }

 private:
  struct Disc {
    Canvas::Circle mark;
    double near;
    float fade;  // fading of the farthest disc
    bool is_point;
  };

  void add(Canvas::Circle mark, float fade = 1, bool is_point = false) {
    auto const [right, up, near] = view_(mark.x, mark.y, mark.z);
    if (!std::isfinite(right) || !std::isfinite(up) || !std::isfinite(near)) return;
    depth_.add(near);
    mark.x = right, mark.y = up, mark.z = 0;
    discs_.push_back({mark, near, fade, is_point});
  }
  void add(Canvas::Point const& p) { add({p.x, p.y, p.size, p.colour, true, false, 0, p.z}, 0, true); }
  void add(Canvas::Cloud const& cloud, double screen) {
    discs_.reserve(discs_.size() + cloud.count());
    // If the colour represents a value, fading is weak, so that the colour bar remains readable.
    float const fade = cloud.value.empty() ? 1 : 0.4F;
    bool const sized = !cloud.diameter.empty() || cloud.common_diameter != 0;
    each_particle(cloud, [&](std::size_t k, double x, double y, double z) {
      double const diameter = !sized                   ? static_cast<double>(cloud.size) * screen / 850
                              : cloud.diameter.empty() ? cloud.common_diameter
                                                       : static_cast<double>(cloud.diameter[k]);
      if (!std::isfinite(diameter)) return;
      Colour const colour =
          cloud.value.empty() ? cloud.colour : map_colour(cloud.map, static_cast<double>(cloud.value[k]));
      add({x, y, std::abs(diameter) / 2, colour, true, cloud.shaded, 0, z}, fade);
    });
  }

  View const& view_;
  std::vector<Disc> discs_;
  Interval depth_;
};

class Flattening {
 public:
  Flattening(Canvas const& space, View const& view, Canvas& flat) : space_(space), view_(view), flat_(flat) {}

  void add_marks(Discs const& discs) {
    bool discs_drawn = false;
    for (auto const& run : space_.order()) {
      if (run.kind == Canvas::Kind::circle || run.kind == Canvas::Kind::point || run.kind == Canvas::Kind::cloud) {
        if (!discs_drawn) discs.draw(flat_);
        discs_drawn = true;
        continue;
      }
      for (std::size_t i = run.first; i < run.first + run.count; ++i) {
        if (run.kind == Canvas::Kind::line) flat_.line(segment(space_.lines()[i]));
        if (run.kind == Canvas::Kind::arrow) flat_.arrow(segment(space_.arrows()[i]));
        if (run.kind == Canvas::Kind::curve) flat_.curve(projected(space_.curves()[i]));
        if (run.kind == Canvas::Kind::text) flat_.text(projected(space_.texts()[i]));
      }
    }
  }

 private:
  template <class Segment>
  Segment segment(Segment mark) const {
    auto const from = view_(mark.x0, mark.y0, mark.z0), to = view_(mark.x1, mark.y1, mark.z1);
    mark.x0 = from.right, mark.y0 = from.up, mark.z0 = 0;
    mark.x1 = to.right, mark.y1 = to.up, mark.z1 = 0;
    return mark;
  }
  Canvas::Curve projected(Canvas::Curve curve) const {
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      auto const place = view_(curve.x[i], curve.y[i], curve.z.empty() ? 0.0 : curve.z[i]);
      curve.x[i] = place.right;
      curve.y[i] = place.up;
    }
    curve.z.clear();
    return curve;
  }
  Canvas::Text projected(Canvas::Text text) const {
    auto const place = view_(text.x, text.y, text.z);
    text.x = place.right, text.y = place.up, text.z = 0;
    return text;
  }

  Canvas const& space_;
  View const& view_;
  Canvas& flat_;
};

}  // namespace

Place Projection::operator()(double x, double y, double z) const { return View(*this)(x, y, z); }

Box3 space_box(Canvas const& space) {
  std::array<Axis const*, 3> const axes{&space.x_axis(), &space.y_axis(), &space.z_axis()};
  auto const given = [](Axis const* axis) { return std::isfinite(axis->low) && std::isfinite(axis->high); };
  std::array<Interval, 3> content;
  if (!std::all_of(axes.begin(), axes.end(), given))
    each_place_of(space, [&](double x, double y, double z) {
      content[0].add(x);
      content[1].add(y);
      content[2].add(z);
    });
  double widest = 0;
  for (auto& side : content) {
    if (side.low > side.high) side.low = 0, side.high = 1;
    widest = std::max(widest, side.width());
  }
  if (!(widest > 0)) widest = 1;
  Box3 box;
  for (std::size_t a = 0; a < 3; ++a) {
    double const room = std::max(0.02 * widest, (0.05 * widest - content[a].width()) / 2);
    box[a] = {std::isfinite(axes[a]->low) ? axes[a]->low : content[a].low - room,
              std::isfinite(axes[a]->high) ? axes[a]->high : content[a].high + room};
    if (box[a][0] > box[a][1]) std::swap(box[a][0], box[a][1]);
  }
  return box;
}

Canvas flattened(Canvas const& space) {
  if (!space.projection()) return space;
  View const view(*space.projection());
  std::array<Axis const*, 3> const axes{&space.x_axis(), &space.y_axis(), &space.z_axis()};
  Box3 const box = space_box(space);
  BoxOutline const outline(box, axes, view);
  auto const ranges = outline.ranges();
  Canvas flat;
  flat.title(space.title());
  flat.equal_aspect(true);
  flat.frame(false);
  flat.axes({"", "", ranges[0].low, ranges[0].high}, {"", "", ranges[1].low, ranges[1].high});
  for (auto const& entry : space.legend_entries()) flat.legend(entry.label, entry.colour);
  for (auto const& bar : space.colour_bars())
    flat.colour_bar(bar.label, bar.unit, bar.low, bar.high, bar.map, bar.factor);
  for (auto const& note : space.notes()) flat.note(note);
  outline.draw_behind(flat);
  Flattening(space, view, flat).add_marks(Discs(space, view, std::max(ranges[0].width(), ranges[1].width())));
  outline.draw_before(flat);
  outline.name_axes(flat);
  if (!space.images().empty()) flat.note("images can't be shown in a space");
  flat.not_finite(space.not_finite());
  return flat;
}

}  // namespace boltzmann
