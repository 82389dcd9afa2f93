// The keys of bodies.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/number.hpp>
#include <boltzmann/schemes/panels/body_options.hpp>

namespace boltzmann {

Words<BodyShape> const& body_shape_words() {
  static Words<BodyShape> const all{"shape",
                                    {{BodyShape::circle, "circle", "`radius` around `centre`"},
                                     {BodyShape::ellipse, "ellipse", "`semi_axes` around `centre`, turned by `angle`"},
                                     {BodyShape::naca, "naca", "four-digit NACA aerofoil"},
                                     {BodyShape::polygon, "polygon", "through `points`"},
                                     {BodyShape::file, "file", "a polygon from a file"}}};
  return all;
}

OptionTable const& body_options() {
  using namespace option;
  using B = BodyOptions;
  static OptionTable const all = [] {
    OptionTable all;
    all.add("name", &B::name, text(), "name of the ensemble of the body's panels, in tables, columns and legends");
    all.add("shape", &B::shape, body_shape_words(),
            "circle, ellipse, four-digit NACA aerofoil with a closed trailing edge, or polygon, also from a file");
    all.add("centre", &B::centre, vector(dimensions::length),
            "centre of a circle or ellipse, quarter chord of an aerofoil, origin of a file", "the origin");
    all.add("radius", &B::radius, number(dimensions::length, positive), "radius of a circle");
    all.add("semi_axes", &B::semi_axes, vector(dimensions::length),
            "semi-axes of an ellipse, along x and y before it is turned");
    all.add("naca", &B::naca, text(),
            "digits of an aerofoil: camber (% of the chord), its place (tenths) and thickness (%)");
    all.add("chord", &B::chord, number(dimensions::length, positive), "chord of an aerofoil");
    all.add("angle", &B::angle, degrees(),
            "counterclockwise turn of an ellipse or file; angle of attack of an aerofoil, nose up");
    all.add("points", &B::points, numbers(dimensions::length), "corners of a polygon in either direction");
    all.add("path", &B::path, path(),
            "path, relative to the scenario: x and y of one corner per line, in either direction");
    all.add("length", &B::length, number(dimensions::length, positive), "unit of length in the file", "the base unit");
    all.add("panels", &B::panels, whole(3, 2000), "panels of the outline; at most 2000 for all bodies");
    all.add("circulation", &B::sheet, &BodySheet::circulation, number(dimensions::circulation),
            "circulation of the body's vortex sheet, counterclockwise");
    all.add("kutta", &B::sheet, &BodySheet::kutta, flag(),
            "the flow leaves the trailing edge smoothly, which sets the circulation; for polygons the edge is the "
            "first point");
    all.add("no_slip", &B::no_slip, text(),
            "ensemble of the vortices that a no-slip wall sheds; class `Diffusive` with a viscosity",
            "the fluid slips");
    all.add("colour", &B::appearance, &Appearance::colour, text(), "colour in pictures", "automatic");
    all.add("diameter", &B::appearance, &Appearance::diameter, number(dimensions::length, not_negative),
            "width of panels in pictures", "their length");
    all.at("name").needed = "\"cylinder\"";
    all.at("shape").needed = "\"circle\"";
    all.at("radius").needed = "1";
    all.at("semi_axes").needed = "[2, 1]";
    all.at("naca").needed = "\"0012\"";
    all.at("chord").needed = "1";
    all.at("path").needed = "\"wing.txt\"";
    all.at("points").needed = "[[0, 0], [1, 0], [0, 1]]";
    return all;
  }();
  return all;
}

Outline outline_of(BodyOptions const& options) {
  auto const place = [](std::optional<std::array<double, 3>> const& numbers) {
    return numbers ? Vector<2>{(*numbers)[0], (*numbers)[1]} : Vector<2>{0, 0};
  };
  auto const panels = static_cast<std::size_t>(options.panels);
  double const angle = options.angle * pi / 180;
  switch (options.shape) {
    case BodyShape::circle:
      return circle_outline(place(options.centre), options.radius, panels);
    case BodyShape::ellipse: {
      auto const axes = place(options.semi_axes);
      if (!(axes[0] > 0 && axes[1] > 0)) throw Error("semi_axes: both must be above zero");
      return ellipse_outline(place(options.centre), axes[0], axes[1], angle, panels);
    }
    case BodyShape::naca:
      return naca_outline(options.naca, place(options.centre), options.chord, angle, panels);
    case BodyShape::file:
      return outline_from_file(options.path, panels,
                               {options.length > 0 ? options.length : 1, angle, place(options.centre)},
                               options.sheet.kutta);
    case BodyShape::polygon:
      break;
  }
  std::vector<Vector<2>> points;
  for (auto const& point : options.points) points.push_back({point[0], point[1]});
  return polygon_outline(points, panels, options.sheet.kutta);
}

OptionTable body_options(BodyShape shape) {
  std::vector<OptionKey> keys{{"name"}, {"shape"}};
  if (shape != BodyShape::polygon) keys.push_back({"centre"});
  if (shape == BodyShape::circle) keys.push_back({"radius"});
  if (shape == BodyShape::ellipse) keys.push_back({"semi_axes"});
  if (shape == BodyShape::naca) keys.push_back({"naca"}), keys.push_back({"chord"});
  bool const turns = shape == BodyShape::ellipse || shape == BodyShape::naca || shape == BodyShape::file;
  if (shape == BodyShape::file) keys.push_back({"path"}), keys.push_back({"length"});
  if (turns) keys.push_back({"angle"});
  if (shape == BodyShape::polygon) keys.push_back({"points"});
  for (char const* key : {"panels", "circulation"}) keys.push_back({key});
  if (shape != BodyShape::circle && shape != BodyShape::ellipse) keys.push_back({"kutta"});
  for (char const* key : {"no_slip", "colour", "diameter"}) keys.push_back({key});
  return body_options().only(keys);
}

}  // namespace boltzmann
