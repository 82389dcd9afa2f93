// Layout of a canvas on paper: margins, ticks, titles, legend and colour bars.
#include <boltzmann/pictures/figure_plan.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

// Sizes in pixels of a picture of 1200 x 900.
namespace size {
constexpr double outer = 20, tick_text = 20, axis_title = 22, legend = 20;
constexpr double tick = 7, minor_tick = 4, tick_gap = 6, title_gap = 12, frame_line = 1.3, grid_line = 1;
constexpr double bar_gap = 28, bar = 22, legend_row = 31, note_row = 23;
constexpr double heading_row = 1.4;  // in units of its font
}  // namespace size

std::string axis_title(std::string const& label, std::string const& unit) {
  if (unit.empty()) return label;
  return label.empty() ? fmt::format("({})", unit) : fmt::format("{} ({})", label, unit);
}

std::string counted(std::size_t count, std::string const& what) {
  return std::to_string(count) + (count == 1 ? " point " : " points ") + what;
}

bool shares_digits(Ticks const& ticks) { return ticks.multiplier.find(' ') != std::string::npos; }

struct Key {
  std::string label;
  Colour colour;
  bool line = false, dashed = false;
};

struct Bar {
  Ticks ticks;
  double labels = 0, width = 0;
};

class Planner {
 public:
  Planner(Canvas const& canvas, Paper const& paper, TextWidth const& width)
      : canvas_(canvas), paper_(paper), text_width_(width), bars_(canvas.colour_bars().size()) {
    for (auto const& entry : canvas.legend_entries()) keys_.push_back({entry.label, entry.colour});
    for (auto const& curve : canvas.curves())
      if (!curve.label.empty()) keys_.push_back({curve.label, curve.colour, true, curve.dashed});
    plan();
  }

  FigurePlan placed() {
    FigurePlan plan;
    plan.box = box_;
    plan.x = x_;
    plan.y = y_;
    plan.frame_line = line_width(size::frame_line);
    plan.grid_line = line_width(size::grid_line);
    if (canvas_.frame()) place_frame(plan);
    place_heading(plan);
    double left = box_.right();
    for (std::size_t i = 0; i < bars_.size(); ++i) {
      place_colour_bar(plan, canvas_.colour_bars()[i], bars_[i], left + length(size::bar_gap));
      left += bars_[i].width;
    }
    double y = notes_top_;
    for (auto const& line : notes_)
      plan.notes.push_back(
          {line, canvas_.frame() ? box_.left : length(size::outer), y += length(size::note_row), note_font()});
    return plan;
  }

 private:
  double length(double pixels) const { return pixels * paper_.unit; }
  // On raster surfaces, thin straight lines have a width of whole pixels.
  double line_width(double pixels) const {
    return paper_.whole_pixels ? std::max(1.0, std::round(length(pixels))) : length(pixels);
  }
  double crisp(double at, double width) const {
    if (!paper_.whole_pixels) return at;
    return static_cast<int>(std::lround(width)) % 2 == 1 ? std::floor(at) + 0.5 : std::round(at);
  }
  double whole(double at) const { return paper_.whole_pixels ? std::round(at) : at; }
  DeviceBox crisp(DeviceBox const& box, double width) const {
    double const left = crisp(box.left, width), top = crisp(box.top, width);
    return {left, top, crisp(box.right(), width) - left, crisp(box.bottom(), width) - top};
  }

  Font tick_font() const { return {length(size::tick_text)}; }
  Font title_font() const { return {length(size::axis_title)}; }
  Font legend_font() const { return {length(size::legend)}; }
  Font heading_font() const { return {length(paper_.heading), true}; }
  Font note_font() const { return {length(paper_.note)}; }

  double widest(Ticks const& ticks) const {
    double most = 0;
    for (auto const& label : ticks.labels) most = std::max(most, text_width_(label, tick_font()));
    return most;
  }
  Font fitted(std::string const& text, Font font, double most) const {
    double const wide = text_width_(text, font);
    return wide > most ? Font{font.size * most / wide} : font;
  }

  // The largest number of ticks whose labels don't overlap.
  Ticks ticks_that_fit(AxisRange const& range, double extent, bool across, int at_most_exponent = 400) const {
    for (int most = 8;; --most) {
      Ticks ticks =
          ticks_between(range.low * range.factor, range.high * range.factor, range.logarithmic, most, at_most_exponent);
      for (auto* values : {&ticks.major, &ticks.minor})
        for (double& value : *values) value /= range.factor;
      bool fits = true;
      double before_at = 0, before_width = 0;
      for (std::size_t i = 0; i < ticks.major.size(); ++i) {
        double const at = range.place(ticks.major[i]) * extent;
        double const wide =
            across ? text_width_(ticks.labels[i], tick_font()) + length(16) : length(1.7 * size::tick_text);
        if (i > 0 && at - before_at < (wide + before_width) / 2) fits = false;
        before_at = at;
        before_width = wide;
      }
      if (fits || most <= 2) return ticks;
    }
  }

  // The ticks of both axes. With equal scales, both use the same power of ten.
  void choose_ticks(bool equal) {
    x_ticks_ = y_ticks_ = {};
    if (!canvas_.frame()) return;
    x_ticks_ = ticks_that_fit(x_, box_.width, true);
    y_ticks_ = ticks_that_fit(y_, box_.height, false);
    if (!equal || x_ticks_.multiplier.empty() || y_ticks_.multiplier.empty()) return;
    int const exponent = std::min(x_ticks_.exponent, y_ticks_.exponent);
    x_ticks_ = ticks_that_fit(x_, box_.width, true, exponent);
    y_ticks_ = ticks_that_fit(y_, box_.height, false, exponent);
  }

  // Margins depend on tick labels, these on the frame, and the frame on the margins. Three iterations suffice.
  void plan() {
    double const outer = length(size::outer);
    Axis const &x_axis = canvas_.x_axis(), &y_axis = canvas_.y_axis();
    x_title_ = canvas_.frame() ? axis_title(x_axis.label, x_axis.unit) : "";
    y_title_ = canvas_.frame() ? axis_title(y_axis.label, y_axis.unit) : "";
    box_ = {outer, outer, paper_.width - 2 * outer, paper_.height - 2 * outer};
    for (int round = 0; round < 3; ++round) {
      auto const ranges = axis_ranges(canvas_, box_.width / box_.height);
      x_ = ranges[0];
      y_ = ranges[1];
      x_.factor = x_axis.factor;
      y_.factor = y_axis.factor;
      bool const equal = canvas_.equal_aspect() && !x_.logarithmic && !y_.logarithmic;
      if (equal) widen_thin_ranges();
      choose_ticks(equal);
      double const right = plan_right(outer), left = plan_left(outer);
      plan_heading(left, right);
      double const top = plan_above(outer), bottom = plan_below(left, right);

      DeviceBox const room{left, top, std::max(paper_.width - left - right, 8.0),
                           std::max(paper_.height - top - bottom, 8.0)};
      fit_box(room, equal);
      double const notes = static_cast<double>(notes_.size()) * length(size::note_row);
      notes_top_ = canvas_.frame() ? box_.bottom() + bottom - outer - notes : paper_.height - 0.8 * outer - notes;
    }
  }

  // The right margin: the last number below the frame may extend beyond it; colour bars are placed beside it.
  double plan_right(double outer) {
    double right = outer;
    if (!x_ticks_.labels.empty()) {
      double const half = text_width_(x_ticks_.labels.back(), tick_font()) / 2;
      right = std::max(right, half - (1 - x_.place(x_ticks_.major.back())) * box_.width + length(8));
    }
    double bars = 0;
    for (std::size_t i = 0; i < bars_.size(); ++i) bars += plan_colour_bar(canvas_.colour_bars()[i], bars_[i]);
    return bars > 0 ? bars + length(12) : right;
  }

  double plan_left(double outer) {
    y_labels_ = canvas_.frame() ? widest(y_ticks_) : 0;
    if (!canvas_.frame()) return outer;
    double left = length(size::tick + size::tick_gap) + y_labels_ + outer;
    if (!y_title_.empty()) left += length(size::title_gap + 1.05 * size::axis_title) - 0.35 * outer;
    if (!y_ticks_.multiplier.empty() && !shares_digits(y_ticks_))
      left = std::max(left, text_width_(y_ticks_.multiplier, tick_font()) + length(size::tick) + 0.5 * outer);
    return left;
  }

  double plan_above(double outer) {
    bool const headed = !keys_.empty() || !title_.empty();
    bool const any_multiplier =
        !y_ticks_.multiplier.empty() ||
        std::any_of(bars_.begin(), bars_.end(), [](Bar const& b) { return !b.ticks.multiplier.empty(); });
    bool const lifted = !y_ticks_.multiplier.empty() && (headed || shares_digits(y_ticks_));
    heading_gap_ = lifted ? length(1.85 * size::tick_text) : length(headed ? 8 : 0);
    return std::max(0.8 * outer + heading_block(), any_multiplier ? length(2.3 * size::tick_text) : outer);
  }

  // The frame in the remaining space; centred if the scales are equal.
  void fit_box(DeviceBox const& room, bool equal) {
    box_ = room;
    if (equal) {
      double const ratio = (x_.high - x_.low) / (y_.high - y_.low);
      box_.width = std::max(std::min(room.width, room.height * ratio), 4.0);
      box_.height = std::max(std::min(room.height, room.width / ratio), 4.0);
      box_.left += (room.width - box_.width) / 2;
      box_.top += (room.height - box_.height) / 2;
    }
    box_ = {whole(box_.left), whole(box_.top), whole(box_.width), whole(box_.height)};
  }

  // With equal scales, a system much longer than high would be too thin: it is padded.
  void widen_thin_ranges() {
    constexpr double thinnest = 0.12;
    auto widen = [](AxisRange& range, double to) {
      double const more = (to - (range.high - range.low)) / 2;
      if (more > 0) {
        range.low -= more;
        range.high += more;
      }
    };
    widen(y_, thinnest * (x_.high - x_.low));
    widen(x_, thinnest * (y_.high - y_.low));
  }

  double plan_colour_bar(Canvas::ColourBar const& bar, Bar& plan) const {
    plan.ticks = bar.high > bar.low ? ticks_that_fit({bar.low, bar.high, false, bar.factor}, box_.height, false)
                                    : Ticks{{bar.low}, {}, {number_text(bar.low * bar.factor)}, ""};
    plan.labels = widest(plan.ticks);
    plan.width = length(size::bar_gap + size::bar + size::tick + size::tick_gap) + plan.labels;
    std::string const title = axis_title(bar.label, bar.unit);
    if (!title.empty()) plan.width += length(size::title_gap + 1.15 * size::axis_title);
    double const multiplier = text_width_(plan.ticks.multiplier, tick_font());
    plan.width = std::max(plan.width, length(size::bar_gap) + multiplier);
    return plan.width;
  }

  // Calls with each key, its distance from the left, and its row.
  template <class Visit>
  void each_key(Visit visit) const {
    double at = 0;
    int row = 0;
    for (auto const& key : keys_) {
      double const next = length(key.line ? 46 : 24) + text_width_(key.label, legend_font());
      if (at > 0 && at + next > keys_wide_) {
        at = 0;
        ++row;
      }
      visit(key, at, row);
      at += next + length(30);
    }
  }

  void plan_heading(double left, double right) {
    double const free = paper_.width - left - right;
    keys_wide_ = std::max(canvas_.equal_aspect() ? box_.width : free, length(260));
    title_ = wrapped(canvas_.title(), std::max(keys_wide_, free), heading_font(), text_width_);
    key_rows_ = 0;
    each_key([&](Key const&, double, int row) { key_rows_ = row + 1; });
  }

  double heading_block() const {
    return static_cast<double>(title_.size()) * size::heading_row * heading_font().size +
           static_cast<double>(key_rows_) * length(size::legend_row) + heading_gap_;
  }

  // The height of the elements below the frame.
  double plan_below(double left, double right) {
    notes_.clear();
    double const wide = std::max(canvas_.frame() ? paper_.width - std::max(left, box_.left) - length(size::outer)
                                                 : paper_.width - 2 * length(size::outer),
                                 length(200));
    auto add = [&](std::string const& note) {
      auto const lines = wrapped(note, wide, note_font(), text_width_);
      notes_.insert(notes_.end(), lines.begin(), lines.end());
    };
    for (auto const& note : canvas_.notes()) add(note);
    if (canvas_.not_finite() > 0) add(counted(canvas_.not_finite(), "not finite"));
    if (std::size_t const hidden = not_positive(canvas_); hidden > 0)
      add(counted(hidden, "not positive, thus not on a logarithmic axis"));
    double below = length(size::outer) + static_cast<double>(notes_.size()) * length(size::note_row);
    if (!canvas_.frame()) return below;
    below += length(size::tick + size::tick_gap + size::tick_text);
    if (!x_title_.empty() || !x_ticks_.multiplier.empty()) below += length(size::title_gap + size::axis_title);
    double const multiplier = text_width_(x_ticks_.multiplier, tick_font());
    double const reach = text_width_(x_title_, title_font()) / 2 + multiplier + length(20);
    x_multiplier_below_ =
        !x_title_.empty() && multiplier > 0 && reach > (paper_.width - left - right) / 2 && reach > box_.width / 2;
    if (x_multiplier_below_) below += length(1.3 * size::tick_text);
    return notes_.empty() ? below : below + length(4);
  }

  double x_at(double value) const { return box_.left + x_.place(value) * box_.width; }
  double y_at(double value) const { return box_.bottom() - y_.place(value) * box_.height; }

  // Calls with the value at each mark of an axis and the length of the mark.
  template <class Visit>
  void each_mark(Ticks const& ticks, Visit visit) const {
    for (double const value : ticks.major) visit(value, length(size::tick));
    for (double const value : ticks.minor) visit(value, length(size::minor_tick));
  }

  static void write(FigurePlan& plan, FigurePlan::Text const& text) {
    if (!text.markup.empty()) plan.texts.push_back(text);
  }

  void place_frame(FigurePlan& plan) const {
    double const wide = plan.frame_line;
    Font const font = tick_font();
    DeviceBox const rim = crisp(box_, wide);
    plan.rims.push_back(rim);
    for (double const value : x_ticks_.major) plan.x_grid.push_back(crisp(x_at(value), plan.grid_line));
    for (double const value : y_ticks_.major) plan.y_grid.push_back(crisp(y_at(value), plan.grid_line));
    each_mark(x_ticks_, [&](double value, double reach) {
      double const x = crisp(x_at(value), wide);
      plan.marks.push_back({{x, rim.bottom()}, {x, rim.bottom() + reach}});
    });
    each_mark(y_ticks_, [&](double value, double reach) {
      double const y = crisp(y_at(value), wide);
      plan.marks.push_back({{rim.left, y}, {rim.left - reach, y}});
    });

    double const label_row = rim.bottom() + length(size::tick + size::tick_gap) + 0.76 * font.size;
    for (std::size_t i = 0; i < x_ticks_.major.size(); ++i)
      write(plan, {x_ticks_.labels[i], x_at(x_ticks_.major[i]), label_row, font, 0.5});
    double const label_right = rim.left - length(size::tick + size::tick_gap);
    for (std::size_t i = 0; i < y_ticks_.major.size(); ++i)
      write(plan, {y_ticks_.labels[i], label_right, y_at(y_ticks_.major[i]) + 0.36 * font.size, font, 1});

    double const title_row = label_row + length(size::title_gap + size::axis_title);
    Font const x_font = fitted(x_title_, title_font(), paper_.width - length(size::outer));
    double const half = text_width_(x_title_, x_font) / 2, centre = paper_.width / 2;
    double const middle =
        std::clamp(box_.left + box_.width / 2, std::min(half, centre), std::max(paper_.width - half, centre));
    write(plan, {x_title_, middle, title_row, x_font, 0.5});
    write(plan, {x_ticks_.multiplier, box_.right(), title_row + (x_multiplier_below_ ? 1.3 * font.size : 0), font, 1});
    Font const y_font = fitted(y_title_, title_font(), paper_.height - length(size::outer));
    write(plan,
          {y_title_, label_right - y_labels_ - length(size::title_gap), box_.top + box_.height / 2, y_font, 0.5, true});
    if (shares_digits(y_ticks_))
      write(plan, {y_ticks_.multiplier, label_right - y_labels_, rim.top - length(13), font});
    else
      write(plan, {y_ticks_.multiplier, rim.left - length(size::tick), rim.top - length(15), font, 1});
  }

  void place_heading(FigurePlan& plan) const {
    double const left = canvas_.frame() ? box_.left : length(size::outer);
    double const top = box_.top - heading_block();
    double y = canvas_.frame() ? top : std::min(top, 0.8 * length(size::outer));
    Font const bold = heading_font();
    double wide = 0;
    for (auto const& line : title_) wide = std::max(wide, text_width_(line, bold));
    double const title_left = std::max(std::min(left, paper_.width - length(size::outer) - wide), length(size::outer));
    for (auto const& line : title_) {
      write(plan, {line, title_left, y + 0.8 * bold.size, bold});
      y += size::heading_row * bold.size;
    }
    each_key([&](Key const& key, double at, int row) {
      Font const font = legend_font();
      double const base = y + row * length(size::legend_row) + 0.8 * font.size, middle = base - 0.36 * font.size;
      DevicePoint const from{left + at + (key.line ? 0 : length(8)), middle};
      plan.keys.push_back(
          {from, {key.line ? left + at + length(36) : from.x, middle}, key.colour, key.line, key.dashed});
      write(plan, {key.label, left + at + length(key.line ? 46 : 24), base, font});
    });
  }

  void place_colour_bar(FigurePlan& plan, Canvas::ColourBar const& bar, Bar const& planned, double left) const {
    double const wide = plan.frame_line;
    Font const font = tick_font();
    DeviceBox const area{whole(left), box_.top, whole(length(size::bar)), box_.height};
    DeviceBox const rim = crisp(area, wide);
    bool const some = bar.high > bar.low;
    plan.bars.push_back({area, bar.map, some});
    plan.rims.push_back(rim);
    AxisRange const range{bar.low, bar.high};
    auto const height = [&](double value) { return area.bottom() - (some ? range.place(value) : 0.5) * area.height; };
    each_mark(planned.ticks, [&](double value, double reach) {
      double const y = crisp(height(value), wide);
      plan.marks.push_back({{rim.right(), y}, {rim.right() + reach, y}});
    });
    double const labels = rim.right() + length(size::tick + size::tick_gap) + planned.labels;
    for (std::size_t i = 0; i < planned.ticks.major.size(); ++i)
      write(plan, {planned.ticks.labels[i], labels, height(planned.ticks.major[i]) + 0.36 * font.size, font, 1});
    write(plan, {planned.ticks.multiplier, rim.left, rim.top - length(15), font});
    std::string const title = axis_title(bar.label, bar.unit);
    write(plan, {title, labels + length(size::title_gap + 0.8 * size::axis_title), box_.top + box_.height / 2,
                 fitted(title, title_font(), paper_.height - length(size::outer)), 0.5, true});
  }

  Canvas const& canvas_;
  Paper const paper_;
  TextWidth const& text_width_;
  std::vector<Key> keys_;
  std::vector<Bar> bars_;
  DeviceBox box_;
  AxisRange x_, y_;
  Ticks x_ticks_, y_ticks_;
  std::string x_title_, y_title_;
  std::vector<std::string> title_, notes_;
  double y_labels_ = 0, heading_gap_ = 0, keys_wide_ = 0, notes_top_ = 0;
  int key_rows_ = 0;
  bool x_multiplier_below_ = false;
};

}  // namespace

std::vector<std::string> wrapped(std::string_view markup, double most, Font font, TextWidth const& width) {
  std::vector<std::string> lines;
  std::string line;
  std::size_t begin = 0;
  while (begin < markup.size()) {
    std::size_t const end = std::min(markup.find(' ', begin), markup.size());
    std::string const longer = (line.empty() ? "" : line + " ") + std::string(markup.substr(begin, end - begin));
    if (!line.empty() && width(longer, font) > most) {
      lines.push_back(line);
      line = markup.substr(begin, end - begin);
    } else {
      line = longer;
    }
    begin = end + 1;
  }
  if (!line.empty()) lines.push_back(line);
  return lines;
}

FigurePlan plan_figure(Canvas const& canvas, Paper const& paper, TextWidth const& width) {
  return Planner(canvas, paper, width).placed();
}

}  // namespace boltzmann
