// The keys of bodies.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/number.hpp>
#include <boltzmann/schemes/panels/body_options.hpp>

namespace boltzmann {

Words<BodyShape> const& body_shape_words() {
  static Words<BodyShape> const all{"shape",
                                    {{BodyShape::circle, "circle", "`radius` around `centre`"},
                                     {BodyShape::ellipse, "ellipse", "`semi_axes` around `centre`, turned by `angle`"},
                                     {BodyShape::naca, "naca", "an aerofoil of four digits"},
                                     {BodyShape::polygon, "polygon", "through `points`"},
                                     {BodyShape::file, "file", "a polygon through the points of a file"}}};
  return all;
}

OptionTable const& body_options() {
  using namespace option;
  using B = BodyOptions;
  static OptionTable const all = [] {
    OptionTable all;
    all.add("name", &B::name, text(),
            "for the rest of the file, the columns and the legends: the body's panels are an "
            "ensemble of this name");
    all.add(
        "shape", &B::shape, body_shape_words(),
        "a circle, an ellipse, an aerofoil of NACA's four digits with a closed trailing edge, a polygon, also from a "
        "file");
    all.add("centre", &B::centre, vector(dimensions::length),
            "of a circle or ellipse; of an aerofoil the quarter of its chord; of a file its origin", "the origin");
    all.add("radius", &B::radius, number(dimensions::length, positive), "of a circle");
    all.add("semi_axes", &B::semi_axes, vector(dimensions::length), "of an ellipse, along x and y before it is turned");
    all.add("naca", &B::naca, text(),
            "four digits: camber and its place, per cent and tenths of the chord; thickness, per "
            "cent");
    all.add("chord", &B::chord, number(dimensions::length, positive), "of an aerofoil");
    all.add("angle", &B::angle, degrees(),
            "of an ellipse or a file's shape counterclockwise; of an aerofoil that of attack, which lifts its nose");
    all.add("points", &B::points, numbers(dimensions::length), "corners of a polygon, pairs, either way around");
    all.add("path", &B::path, path(),
            "of a file, from the scenario's folder: x and y of one corner a line, either way around");
    all.add("length", &B::length, number(dimensions::length, positive), "the file's unit of length", "the base's");
    all.add("panels", &B::panels, whole(3, 2000),
            "how many pieces the outline is cut into; 2000 of all bodies at most");
    all.add("circulation", &B::sheet, &BodySheet::circulation, number(dimensions::circulation),
            "of the body's vortex sheet, counterclockwise");
    all.add(
        "kutta", &B::sheet, &BodySheet::kutta, flag(),
        "the flow leaves the trailing edge smoothly, which gives the circulation; of a polygon, also from a file, its "
        "first point is that "
        "edge");
    all.add(
        "no_slip", &B::no_slip, text(),
        "the ensemble that the vorticity enters which a wall makes where fluid sticks to it; class `Diffusive` with a "
        "viscosity",
        "the fluid slips");
    all.add("colour", &B::appearance, &Appearance::colour, text(), "in pictures, as of an ensemble", "chosen for you");
    all.add("diameter", &B::appearance, &Appearance::diameter, number(dimensions::length, not_negative),
            "of panels in pictures", "their length");
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
