// Maps names known to a page to drawings of the simulation.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/diagnoses/derived.hpp>
#include <boltzmann/pictures/figure.hpp>
#include <boltzmann/pictures/picture_options.hpp>
#include <boltzmann/pictures/projection.hpp>
#include <boltzmann/recording/recording.hpp>
#include <boltzmann/window/option_json.hpp>
#include <boltzmann/window/views.hpp>
#include <boltzmann/window/wire.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace boltzmann {
namespace {

using nlohmann::json;

std::string text_or(json const& object, char const* key, std::string otherwise) {
  auto const found = object.find(key);
  if (found == object.end() || found->is_null()) return otherwise;
  if (!found->is_string()) throw Error(fmt::format("'{}' is a text", key));
  return found->get<std::string>();
}

bool flag_or(json const& object, char const* key, bool otherwise) {
  auto const found = object.find(key);
  if (found == object.end() || found->is_null()) return otherwise;
  if (!found->is_boolean()) throw Error(fmt::format("'{}' is true or false", key));
  return found->get<bool>();
}

std::array<double, 2> range(json const& ends, char const* key) {
  if (!ends.is_array() || ends.size() != 2 || !ends[0].is_number() || !ends[1].is_number())
    throw Error(fmt::format("'{}' is a range, [low, high]", key));
  return {ends[0].get<double>(), ends[1].get<double>()};
}

// "field-energy" -> "Field energy".
std::string first_upper(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  std::replace(text.begin(), text.end(), '-', ' ');
  return text;
}

// The picture of a diagnosis, changed by a view. Missing options are those of the diagnosis; null is automatic.
Picture with(Picture picture, json const& view) {
  std::string const drawing = text_or(view, "drawing", picture.drawing);
  if (drawing != picture.drawing) picture = Picture{.drawing = drawing};
  std::string const colour = text_or(view, "colour", picture.colour);
  if (colour != picture.colour)  // the given ends belong to another quantity
    picture.low = picture.high = std::numeric_limits<double>::quiet_NaN();
  Picture plain;
  for (auto const& option : drawing_named(drawing).options)
    if (auto const value = view.find(option.key); value != view.end()) take(option, *value, &picture, &plain);
  return picture;
}

}  // namespace

double number_or(json const& object, char const* key, double otherwise) {
  auto const found = object.find(key);
  if (found == object.end() || found->is_null()) return otherwise;
  if (!found->is_number()) throw Error(fmt::format("'{}' is a number", key));
  return found->get<double>();
}

Views::Views(Simulation& simulation, UnitSystem const& units, std::string title, std::string folder)
    : simulation_(simulation), units_(units), title_(std::move(title)), folder_(std::move(folder)) {}

std::vector<AnyEnsemble*> Views::ensembles() const { return supervised_by(simulation_.schemes()); }

std::vector<std::string> Views::column_names() const {
  std::vector<std::string> names;
  for (std::size_t c = 2; c < header_.size(); ++c) {
    std::size_t const unit = header_[c].rfind(" (");
    names.push_back(header_[c].substr(0, unit));
  }
  return names;
}

void Views::install(std::string name, std::function<void(Canvas&)> draw) {
  std::erase_if(entries_, [&](Entry const& entry) { return entry.name == name; });
  entries_.push_back({std::move(name), {}, std::move(draw)});
}

void Views::add(std::string name, Picture picture, Unfit unfit) {
  for (auto const& entry : entries_)
    if (entry.name == name) return;
  bool const table = picture.drawing == "time-series";
  if (table && header_.empty() && unfit == Unfit::left_out) return;
  try {
    check(picture, ensembles(), column_names(), sources(picture));
  } catch (Error const&) {
    if (unfit == Unfit::throws) throw;
    return;
  }
  picture.trace = false;
  entries_.push_back({std::move(name), std::move(picture), {}, table});
}

PictureSources Views::sources(Picture const& picture) const {
  PictureSources all{{}, instruments_, &units_};
  if (picture.drawing == "mesh") all.mesh_fields = mesh_fields_of(simulation_.schemes());
  return all;
}

void Views::take(Recording const& recording) {
  header_ = recording.header();
  instruments_ = recording.instruments();
  for (auto const& picture : recording.pictures()) {
    std::string const stem = picture.file.substr(0, picture.file.rfind('.'));
    std::string const what = picture.drawing == "cartesian" ? "particles" : picture.drawing;
    add(first_upper(stem == "picture" ? what : stem), picture);
  }
}

void Views::add_usual() {
  add("Particles", {.drawing = "cartesian"});
  add("Phase space", {.drawing = "phase-space", .x = "position.x", .y = "velocity.x"});
  add("Measured", {.drawing = "time-series"});
  add("Histogram", {.drawing = "histogram", .x = "speed"});
  add("Spectrum", {.drawing = "spectrum", .x = "position.x", .y = "velocity.x"});
  add("Profile", {.drawing = "profile", .x = "position.x", .y = "density"});
  add("Density", {.drawing = "map", .y = "density", .cells = 120});
  add("Mesh", {.drawing = "mesh", .y = "potential"});
  // Views of the state precede those that need a history.
  std::stable_partition(entries_.begin(), entries_.end(), [](Entry const& entry) {
    return !entry.table && entry.picture.drawing != "wave-spectrum" && entry.picture.drawing != "curves" &&
           !(entry.picture.drawing == "spectrum" && entry.picture.x == "time");
  });
}

void Views::columns(std::vector<std::string> header) { header_ = std::move(header); }

json Views::describe() const {
  auto const length = units_.display(dimensions::length), time = units_.display(dimensions::time);
  double const step = simulation_.step_size();
  json result{{"title", title_},
              {"folder", folder_},
              {"length_unit", length.unit},
              {"length_factor", length.factor},
              {"time_unit", time.unit},
              {"step_size_number", step},
              {"step_size", units_.is_reduced() ? fmt::format("{:g}", step) : quantity(step, dimensions::time)},
              {"maps", colour_maps_json()}};
  describe_box(result);
  describe_ensembles(result);
  describe_pictures(result);
  json& colours = result["colours"] = json::array();
  for (int k = 0; k < 16; ++k) colours.push_back(colour_text(species_colour(k)));
  return result;
}

void Views::describe_box(json& result) const {
  Box const& box = simulation_.schemes().front()->box();
  result["dimension"] = box.dimension();
  json sides{{"low", json::array()}, {"high", json::array()}, {"boundary", json::array()}};
  for (int a = 0; a < box.dimension(); ++a) {
    sides["low"].push_back(box.low(a));
    sides["high"].push_back(box.high(a));
    sides["boundary"].push_back(to_string(box.boundary(a)));
  }
  result["box"] = sides;
}

void Views::describe_ensembles(json& result) const {
  json &all = result["ensembles"] = json::array(), &together = result["quantities"] = json::array();
  std::vector<std::string> vectors, names;
  int number = 0;
  for (auto const* ensemble : ensembles()) {
    json list = json::array();
    for (auto const& meaning : quantities(*ensemble)) {
      json one{{"name", meaning.name}, {"label", meaning.label}, {"unit", units_.display(meaning.dimension).unit}};
      list.push_back(one);
      if (std::find(names.begin(), names.end(), meaning.name) == names.end()) {
        names.push_back(meaning.name);
        together.push_back(one);
      }
      bool const first = meaning.name.ends_with(".x");
      std::string const stem = meaning.name.substr(0, meaning.name.rfind('.'));
      if (first && stem != "position" && std::find(vectors.begin(), vectors.end(), stem) == vectors.end())
        vectors.push_back(stem);
    }
    auto const& own = ensemble->appearance.colour;
    bool const given = static_cast<std::size_t>(number) < palette_.size();
    Colour const colour = !own.empty() ? colour_named(own)
                          : given      ? palette_[static_cast<std::size_t>(number)]
                                       : species_colour(number);
    all.push_back({{"name", ensemble->name()},
                   {"class", ensemble->class_name()},
                   {"size", ensemble->size()},
                   {"colour", colour_text(colour)},
                   {"quantities", std::move(list)}});
    ++number;
  }
  result["vectors"] = vectors;
}

void Views::describe_pictures(json& result) const {
  json& diagnoses = result["diagnoses"] = json::array();
  for (auto const& entry : entries_) {
    Picture const& p = entry.picture;
    std::string const drawing = entry.installed ? "installed" : entry.table ? "table" : p.drawing;
    json& shown = diagnoses.emplace_back(json{{"name", entry.name}, {"drawing", drawing}});
    if (entry.installed) continue;
    Picture picture = p;
    for (auto const& option : drawing_named(p.drawing).options) shown[option.key] = option_json(option, &picture);
  }
  json& drawings = result["drawings"] = json::object();
  for (auto const& drawing : boltzmann::drawings()) {
    json& options = drawings[drawing.name] = json::array();
    for (auto const& option : drawing.options)
      options.push_back({{"key", option.key}, {"doc", option.doc}, {"words", option.kind.words}});
  }
  json& columns = result["columns"] = json::array();
  for (std::size_t c = 2; c < header_.size(); ++c) {
    std::size_t const unit = header_[c].rfind(" (");
    columns.push_back(
        {{"name", header_[c].substr(0, unit)},
         {"unit", unit == std::string::npos ? "" : header_[c].substr(unit + 2, header_[c].size() - unit - 3)}});
  }
}

Views::Entry const& Views::entry(std::string const& name) const {
  std::vector<std::string> names;
  for (auto const& entry : entries_) {
    if (entry.name == name) return entry;
    names.push_back(entry.name);
  }
  throw Error(fmt::format("there is no diagnosis '{}'{}", name, boltzmann::choices(name, names)));
}

Canvas Views::canvas(Entry const& entry, json const& view, std::int64_t step, double time) const {
  if (entry.installed) {
    Canvas own;
    own.title(entry.name);
    entry.installed(own);
    return own;
  }
  Picture picture = with(entry.picture, view);
  picture.palette = palette_;
  if (picture.trace && folder_.empty()) throw Error("tracks need the trajectory, which this run does not record");
  check(picture, ensembles(), column_names(), sources(picture));
  return boltzmann::draw(
      picture, {simulation_, units_, title_, step, time, folder_, instruments_, default_threads(), memory_.get()});
}

std::shared_ptr<Canvas const> Views::draw(json const& view, std::int64_t step, double time) const {
  Entry const& what = entry(text_or(view, "diagnosis", ""));
  if (what.table) return nullptr;
  // The deleter recycles its arrays when they have been sent to the last browser.
  return {new Canvas(canvas(what, view, step, time)), [memory = memory_](Canvas const* shown) {
            auto* const canvas = const_cast<Canvas*>(shown);  // it was created non-const one line above
            memory->keep(canvas->take_clouds());
            delete canvas;
          }};
}

PictureFile Views::picture(json const& request, std::int64_t step, double time) const {
  if (!request.contains("view") || !request["view"].is_object()) throw Error("a picture is one of a \"view\"");
  json const& view = request["view"];
  std::string const format = text_or(request, "format", "png");
  Entry const& what = entry(text_or(view, "diagnosis", ""));
  Canvas drawn = canvas(what, view, step, time);
  if (drawn.projection() && (view.contains("x_range") || view.contains("y_range"))) drawn = flattened(drawn);
  if (!drawn.projection()) {
    Axis x = drawn.x_axis(), y = drawn.y_axis();
    if (view.contains("x_range"))
      x.low = range(view["x_range"], "x_range")[0], x.high = range(view["x_range"], "x_range")[1];
    if (view.contains("y_range"))
      y.low = range(view["y_range"], "y_range")[0], y.high = range(view["y_range"], "y_range")[1];
    drawn.axes(x, y);
  }
  FigureOptions paper;
  paper.width = static_cast<int>(std::clamp(number_or(request, "width", 1200), 16.0, 8000.0));
  paper.height = static_cast<int>(std::clamp(number_or(request, "height", 900), 16.0, 8000.0));
  paper.scale = std::clamp(number_or(request, "scale", 1), 0.1, 8.0);
  paper.dark = flag_or(request, "dark", false);
  PictureFile file;
  file.content = picture_bytes(drawn, format, paper);
  file.type = format == "png" ? "image/png" : format == "svg" ? "image/svg+xml" : "application/pdf";
  std::string name = folder_.empty() ? "picture" : folder_.substr(folder_.rfind('/') + 1);
  file.name = fmt::format("{}-{}.{}", name, step, format);
  if (format == "png") {
    auto const layout = layout_of(drawn, paper);
    file.frame = {layout.left, layout.top, layout.width, layout.height};
  }
  return file;
}

json Views::particle(std::string const& name, std::size_t number) const {
  for (auto const* ensemble : ensembles()) {
    if (ensemble->name() != name || number >= ensemble->size()) continue;
    double const* row = ensemble->row(number);
    json position = json::array(), fields = json::array();
    for (int a = 0; a < ensemble->dimension(); ++a) position.push_back(row[a]);
    double speed2 = 0;
    Field const* velocity = ensemble->find_field("velocity");
    for (auto const& meaning : quantities(*ensemble)) {
      // A name is a field, with a component after a dot if it has several.
      std::size_t const dot = meaning.name.rfind('.');
      Field const* field = ensemble->find_field(meaning.name.substr(0, dot));
      if (!field) continue;
      int component = 0;
      if (dot != std::string::npos) {
        std::string const letters = meaning.name.substr(dot + 1);
        for (char const c : letters) component = component * ensemble->dimension() + (c - 'x');
      }
      if (component < 0 || component >= field->components) continue;
      if (dot == std::string::npos && field->components > 1) continue;
      double const value = row[field->offset + component];
      if (field == velocity) speed2 += value * value;
      fields.push_back(
          {{"name", meaning.name}, {"label", meaning.label}, {"value", quantity(value, meaning.dimension)}});
    }
    if (velocity)
      fields.push_back(
          {{"name", "speed"}, {"label", "speed"}, {"value", quantity(std::sqrt(speed2), velocity->dimension)}});
    return {{"ensemble", name}, {"particle", number}, {"position", position}, {"fields", fields}};
  }
  return nullptr;
}

std::string Views::quantity(double number, Dimension dimension) const { return units_.text(number, dimension, 5); }

}  // namespace boltzmann
