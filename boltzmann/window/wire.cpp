// Converts a canvas to the arrays and words of protocol.md.
#include <boltzmann/pictures/figure_layout.hpp>
#include <boltzmann/pictures/projection.hpp>
#include <boltzmann/window/wire.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace boltzmann {
namespace {

using nlohmann::json;

std::uint32_t byte(float component) {
  return static_cast<std::uint32_t>(std::lround(std::clamp(component, 0.0F, 1.0F) * 255));
}

// r, g, b, a from the lowest byte on.
std::uint32_t packed(Colour colour) {
  std::uint32_t const rgb =
      is_ink(colour) ? 0x010101 : byte(colour.red) | byte(colour.green) << 8 | byte(colour.blue) << 16;
  bool const mistaken = !is_ink(colour) && rgb == 0x010101;
  return (mistaken ? 0x020202 : rgb) | byte(colour.alpha) << 24;
}

char const* name_of(ColourMap map) {
  auto const index = static_cast<std::size_t>(map);
  return colour_map_names()[index].c_str();
}

// JSON has no infinities.
json number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

// Converts coordinates to unit coordinates of the page.
class Places {
 public:
  explicit Places(Canvas const& canvas) : space_(canvas.projection().has_value()) {
    if (!space_) {
      ranges_ = axis_ranges(canvas, 4.0 / 3);
      return;
    }
    box_ = space_box(canvas);
    for (auto const& side : box_) half_ = std::max(half_, (side[1] - side[0]) / 2);
    if (!(half_ > 0)) half_ = 1;
  }

  bool space() const { return space_; }
  double half() const { return half_; }
  std::array<double, 2> range(std::size_t axis) const {
    return space_ ? box_[axis] : std::array{ranges_[axis].low, ranges_[axis].high};
  }
  float operator()(std::size_t axis, double value) const {
    if (space_) return static_cast<float>((value - (box_[axis][0] / 2 + box_[axis][1] / 2)) / half_);
    return axis == 2 ? 0.0F : static_cast<float>(ranges_[axis].place(value));
  }
  float length(double value) const {
    return static_cast<float>(value / (space_ ? half_ : ranges_[0].high - ranges_[0].low));
  }

 private:
  bool space_;
  std::array<AxisRange, 2> ranges_;
  std::array<std::array<double, 2>, 3> box_{};
  double half_ = 0;
};

json axis_json(Axis const& axis, std::array<double, 2> const& range) {
  return {{"label", axis.label},           {"unit", axis.unit},
          {"factor", number(axis.factor)}, {"logarithmic", axis.logarithmic},
          {"low", number(range[0])},       {"high", number(range[1])}};
}

class Encoder {
 public:
  Encoder(std::shared_ptr<Canvas const> canvas, BinaryMessage& message)
      : shared_(std::move(canvas)), canvas_(*shared_), message_(message), places_(canvas_) {}

  json encode() {
    json result{{"title", canvas_.title()},
                {"notes", canvas_.notes()},
                {"grid", canvas_.grid()},
                {"frame", canvas_.frame()},
                {"equal_aspect", canvas_.equal_aspect()},
                {"x", axis_json(canvas_.x_axis(), places_.range(0))},
                {"y", axis_json(canvas_.y_axis(), places_.range(1))}};
    if (places_.space()) {
      result["z"] = axis_json(canvas_.z_axis(), places_.range(2));
      result["azimuth"] = number(canvas_.projection()->azimuth);
      result["elevation"] = number(canvas_.projection()->elevation);
      result["half"] = places_.half();
    }
    json& legend = result["legend"] = json::array();
    for (auto const& entry : canvas_.legend_entries())
      legend.push_back({{"label", entry.label}, {"colour", colour_text(entry.colour)}});
    json& bars = result["bars"] = json::array();
    for (auto const& bar : canvas_.colour_bars())
      bars.push_back({{"label", bar.label},
                      {"unit", bar.unit},
                      {"low", number(bar.low)},
                      {"high", number(bar.high)},
                      {"factor", number(bar.factor)},
                      {"map", name_of(bar.map)}});
    json& marks = result["marks"] = json::array();
    for (auto const& run : canvas_.order()) add(run, marks);
    return result;
  }

 private:
  void add(Canvas::Run const& run, json& marks) {
    std::size_t const end = run.first + run.count;
    data_.clear();
    colours_.clear();
    switch (run.kind) {
      case Canvas::Kind::circle:
        for (std::size_t k = run.first; k < end; ++k) {
          auto const& m = canvas_.circles()[k];
          place(m.x, m.y, m.z);
          put({places_.length(m.radius), m.depth, static_cast<float>((m.filled ? 1 : 0) + (m.shaded ? 2 : 0))},
              m.colour);
        }
        return marks.push_back(packed_marks("circle"));
      case Canvas::Kind::point:
        for (std::size_t k = run.first; k < end; ++k) {
          auto const& m = canvas_.points()[k];
          place(m.x, m.y, m.z);
          put({m.size}, m.colour);
        }
        return marks.push_back(packed_marks("point"));
      case Canvas::Kind::line:
        for (std::size_t k = run.first; k < end; ++k) segment(canvas_.lines()[k]);
        return marks.push_back(packed_marks("line"));
      case Canvas::Kind::arrow:
        for (std::size_t k = run.first; k < end; ++k) segment(canvas_.arrows()[k]);
        return marks.push_back(packed_marks("arrow"));
      case Canvas::Kind::curve:
        for (std::size_t k = run.first; k < end; ++k) marks.push_back(curve(canvas_.curves()[k]));
        return;
      case Canvas::Kind::text: {
        json texts = json::array();
        for (std::size_t k = run.first; k < end; ++k) {
          auto const& m = canvas_.texts()[k];
          place(m.x, m.y, m.z);
          put({m.size, static_cast<float>(m.align)}, m.colour);
          texts.push_back(m.text);
        }
        marks.push_back(packed_marks("text"));
        marks.back()["texts"] = std::move(texts);
        return;
      }
      case Canvas::Kind::image:
        for (std::size_t k = run.first; k < end; ++k) marks.push_back(image(canvas_.images()[k]));
        return;
      case Canvas::Kind::cloud:
        for (std::size_t k = run.first; k < end; ++k) marks.push_back(cloud(canvas_.clouds()[k]));
        return;
    }
  }

  void place(double x, double y, double z) { data_.insert(data_.end(), {places_(0, x), places_(1, y), places_(2, z)}); }
  void put(std::initializer_list<float> numbers, Colour colour) {
    data_.insert(data_.end(), numbers);
    colours_.push_back(packed(colour));
  }
  template <class Segment>
  void segment(Segment const& m) {
    place(m.x0, m.y0, m.z0);
    place(m.x1, m.y1, m.z1);
    put({m.width}, m.colour);
  }
  json packed_marks(char const* kind) {
    return {
        {"kind", kind}, {"data", message_.array(std::move(data_))}, {"colours", message_.array(std::move(colours_))}};
  }

  json curve(Canvas::Curve const& curve) {
    auto const along = [&](std::size_t axis, std::vector<double> const& values) {
      std::vector<float> places;
      places.reserve(values.size());
      for (double const v : values) places.push_back(std::isfinite(v) ? places_(axis, v) : std::nanf(""));
      return message_.array(std::move(places));
    };
    json result{{"kind", "curve"},       {"x", along(0, curve.x)}, {"y", along(1, curve.y)},
                {"label", curve.label},  {"width", curve.width},   {"colour", colour_text(curve.colour)},
                {"dashed", curve.dashed}};
    if (places_.space()) result["z"] = along(2, curve.z.empty() ? std::vector<double>(curve.x.size(), 0) : curve.z);
    return result;
  }

  json image(Canvas::Image const& image) {
    std::vector<unsigned char> pixels;
    pixels.reserve(4 * image.pixels.size());
    for (std::uint32_t const argb : image.pixels)
      for (int const shift : {16, 8, 0, 24}) pixels.push_back(static_cast<unsigned char>(argb >> shift & 255U));
    return {{"kind", "image"},
            {"x0", number(places_(0, image.x0))},
            {"y0", number(places_(1, image.y0))},
            {"x1", number(places_(0, image.x1))},
            {"y1", number(places_(1, image.y1))},
            {"columns", image.columns},
            {"rows", image.rows},
            {"pixels", message_.array(std::move(pixels))}};
  }

  json cloud(Canvas::Cloud const& cloud) {
    json result{{"kind", "cloud"},
                {"count", cloud.count()},
                {"dimension", cloud.dimension},
                {"positions", message_.array(shared_, cloud.position)},
                {"origin", cloud.origin},
                {"scale", cloud.scale},
                {"map", name_of(cloud.map)},
                {"colour", colour_text(cloud.colour)},
                {"diameter", number(cloud.common_diameter)},
                {"size", cloud.size},
                {"shaded", cloud.shaded},
                {"ensemble", cloud.ensemble},
                {"stride", cloud.stride}};
    if (!cloud.value.empty()) result["values"] = message_.array(shared_, cloud.value);
    if (!cloud.diameter.empty()) result["diameters"] = message_.array(shared_, cloud.diameter);
    if (!cloud.number.empty()) result["numbers"] = message_.array(shared_, cloud.number);
    return result;
  }

  std::shared_ptr<Canvas const> shared_;
  Canvas const& canvas_;
  BinaryMessage& message_;
  Places places_;
  std::vector<float> data_;
  std::vector<std::uint32_t> colours_;
};

}  // namespace

json BinaryMessage::add(std::shared_ptr<void const> owner, void const* data, std::size_t bytes, std::size_t count,
                        char const* as) {
  json stored{{"at", bytes_}, {"count", count}, {"as", as}};
  if (bytes > 0) payload_.push_back({std::move(owner), data, bytes});
  static std::array<char, 8> constexpr zeros{};
  std::size_t const padding = (8 - bytes % 8) % 8;
  if (padding > 0) payload_.push_back({nullptr, zeros.data(), padding});
  bytes_ += bytes + padding;
  return stored;
}

namespace {
template <class T>
std::shared_ptr<std::vector<T> const> owned(std::vector<T> values) {
  return std::make_shared<std::vector<T> const>(std::move(values));
}
}  // namespace

json BinaryMessage::array(std::vector<float> values) {
  auto const own = owned(std::move(values));
  return array(own, *own);
}
json BinaryMessage::array(std::vector<double> values) {
  auto const own = owned(std::move(values));
  return add(own, own->data(), own->size() * sizeof(double), own->size(), "f64");
}
json BinaryMessage::array(std::vector<std::uint32_t> values) {
  auto const own = owned(std::move(values));
  return array(own, *own);
}
json BinaryMessage::array(std::vector<unsigned char> values) {
  auto const own = owned(std::move(values));
  return add(own, own->data(), own->size(), own->size(), "u8");
}
json BinaryMessage::array(std::shared_ptr<void const> owner, std::vector<float> const& values) {
  return add(std::move(owner), values.data(), values.size() * sizeof(float), values.size(), "f32");
}
json BinaryMessage::array(std::shared_ptr<void const> owner, std::vector<std::uint32_t> const& values) {
  return add(std::move(owner), values.data(), values.size() * sizeof(std::uint32_t), values.size(), "u32");
}

WebMessage BinaryMessage::finish(json const& head) {
  std::string text = head.dump(-1, ' ', false, json::error_handler_t::replace);
  text.append((8 - (4 + text.size()) % 8) % 8, ' ');
  auto const length = static_cast<std::uint32_t>(text.size());
  std::string start;
  for (int k = 0; k < 4; ++k) start.push_back(static_cast<char>(length >> (8 * k) & 255U));
  WebMessage message{true, {WebPart::of(start + text)}};
  message.parts.insert(message.parts.end(), std::make_move_iterator(payload_.begin()),
                       std::make_move_iterator(payload_.end()));
  payload_.clear();
  bytes_ = 0;
  return message;
}

json canvas_json(std::shared_ptr<Canvas const> const& canvas, BinaryMessage& message) {
  return Encoder(canvas, message).encode();
}

json table_json(ShownTable const& table, std::size_t from, BinaryMessage& message) {
  std::vector<double> rows(table.values.begin() + static_cast<std::ptrdiff_t>(from * table.columns),
                           table.values.end());
  return {{"number", table.number},
          {"from", from},
          {"rows", table.rows() - from},
          {"values", message.array(std::move(rows))}};
}

std::string colour_text(Colour colour) {
  std::uint32_t const rgba = packed(colour);
  std::string text = fmt::format("#{:02x}{:02x}{:02x}", rgba & 255U, rgba >> 8 & 255U, rgba >> 16 & 255U);
  if (rgba >> 24 != 255) text += fmt::format("{:02x}", rgba >> 24);
  return text;
}

json colour_maps_json() {
  json all = json::object();
  for (auto const& name : colour_map_names()) {
    json& map = all[name] = json::array();
    for (int k = 0; k < 256; ++k) map.push_back(colour_text(map_colour(colour_map_named(name), k / 255.0)));
  }
  return all;
}

}  // namespace boltzmann
