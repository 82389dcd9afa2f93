// From the state and the files of a run to the arrays that the drawings want.
#include <boltzmann/diagnoses/contours.hpp>
#include <boltzmann/diagnoses/derived.hpp>
#include <boltzmann/diagnoses/drawings.hpp>
#include <boltzmann/diagnoses/field_measures.hpp>
#include <boltzmann/diagnoses/profile.hpp>
#include <boltzmann/diagnoses/spectrum_of.hpp>
#include <boltzmann/diagnoses/wave_spectrum.hpp>
#include <boltzmann/files/checkpoint.hpp>
#include <boltzmann/files/csv.hpp>
#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/conserved.hpp>
#include <boltzmann/simulation/picture.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace boltzmann {
namespace {

using Values = std::vector<double>;
constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> split(std::string const& text) {
  std::vector<std::string> words;
  std::size_t at = 0;
  while (at <= text.size()) {
    std::size_t const end = std::min(text.find(',', at), text.size());
    std::size_t first = text.find_first_not_of(' ', at);
    std::size_t last = text.find_last_not_of(' ', end == 0 ? 0 : end - 1);
    if (first < end && last != std::string::npos && last >= first)
      words.push_back(text.substr(first, last - first + 1));
    at = end + 1;
  }
  return words;
}

// "kinetic energy (eV)" -> {"kinetic energy", "eV"}.
struct Heading {
  std::string name, unit;
};
Heading heading(std::string const& text) {
  std::size_t const at = text.rfind(" (");
  if (at == std::string::npos || text.back() != ')') return {text, ""};
  return {text.substr(0, at), text.substr(at + 2, text.size() - at - 3)};
}

bool has_quantity(AnyEnsemble const& ensemble, std::string const& name) {
  auto const all = quantities(ensemble);
  return std::any_of(all.begin(), all.end(), [&](auto const& q) { return q.name == name; });
}

// The meaning of a name that at least one of the ensembles knows.
QuantityMeaning meaning(std::vector<AnyEnsemble*> const& ensembles, std::string const& name) {
  for (auto const* ensemble : ensembles)
    if (has_quantity(*ensemble, name)) return quantity_meaning(*ensemble, name);
  if (ensembles.empty()) throw Error("there are no particles to draw");
  return quantity_meaning(*ensembles.front(), name);  // throws, with the allowed names
}

bool needs_influence(std::string const& name) {
  return name == "speed" || name.starts_with("velocity") || name.starts_with("influence");
}

std::vector<AnyEnsemble*> ensembles_of(Simulation const& simulation) {
  std::vector<AnyEnsemble*> all;
  for (auto* scheme : simulation.schemes())
    for (auto* ensemble : scheme->ensembles())
      if (std::find(all.begin(), all.end(), ensemble) == all.end()) all.push_back(ensemble);
  return all;
}

// The wave spectrum of a quantity that a run records; the first one if none is named.
WaveSpectrum const& recorded_waves(std::vector<Diagnosis const*> const& diagnoses, std::string const& quantity) {
  std::vector<std::string> recorded;
  for (auto const* diagnosis : diagnoses)
    if (auto const* waves = dynamic_cast<WaveSpectrum const*>(diagnosis)) {
      if (quantity.empty() || waves->quantity() == quantity) return *waves;
      recorded.push_back(waves->quantity());
    }
  if (!recorded.empty())
    throw Error("no diagnosis wave-spectrum records '" + quantity + "'; recorded is " + join(recorded) +
                did_you_mean(quantity, recorded));
  throw Error("a picture of the wave spectrum needs the diagnosis wave-spectrum, and is drawn when the run ends");
}

void check_spectrum_axis(std::string const& x) {
  if (!x.starts_with("position."))
    throw Error("a spectrum is over position.x, position.y, position.z or time, not '" + x + "'");
}

bool of_smooth_field(Picture const& picture) {
  return picture.drawing == "map" || picture.drawing == "contours" || picture.drawing == "bands";
}

std::string mesh_name(Picture const& picture) { return picture.y.empty() ? "potential" : picture.y; }

// The names of a profile's quantities, and its axis.
std::vector<std::string> profile_names(Picture const& picture) {
  auto const names = split(picture.y);
  return names.empty() ? std::vector<std::string>{"density"} : names;
}
int profile_axis(Picture const& picture, int dimension) {
  if (picture.x.empty()) return 0;
  for (int a = 0; a < dimension; ++a)
    if (picture.x == std::string("position.") + "xyz"[a]) return a;
  throw Error("a profile in " + std::to_string(dimension) + "D is over position.x" +
              (dimension > 1 ? (dimension > 2 ? ", position.y or position.z" : " or position.y") : "") + ", not '" +
              picture.x + "'");
}

class Drawer {
 public:
  Drawer(Picture const& picture, PictureContext const& context)
      : picture_(picture), context_(context), ensembles_(ensembles_of(context.simulation)) {}

  Canvas draw() {
    if (picture_.drawing == "cartesian") return cartesian();
    if (picture_.drawing == "phase-space") return phase_space(picture_.x, picture_.y);
    if (picture_.drawing == "spectrum") return picture_.x == "time" ? spectrum_in_time() : spectrum_in_space();
    if (picture_.drawing == "profile") return profiles();
    if (picture_.drawing == "mesh") return mesh();
    if (picture_.drawing == "wave-spectrum") return wave_spectrum();
    if (of_smooth_field(picture_)) return smooth_field();
    return time_series();
  }

 private:
  Base::Display shown_in(Dimension dimension) const { return context_.base.display(dimension); }
  Axis axis(std::string label, Dimension dimension) const {
    auto const [unit, factor] = shown_in(dimension);
    Axis result{std::move(label), unit};
    result.factor = factor;
    return result;
  }

  // The colour an ensemble was given, or the next of the palette.
  Colour colour(int ensemble) const {
    auto const& name = ensembles_[static_cast<std::size_t>(ensemble)]->appearance.colour;
    return name.empty() ? species_colour(ensemble) : colour_named(name);
  }

  std::string title(bool with_time = true) const {
    if (!with_time) return context_.title;
    std::string text = context_.title.empty() ? "" : context_.title + ", ";
    auto const time = quantity_text(context_.time, dimensions::time, context_.base);
    return text + (time.find(' ') == std::string::npos ? fmt::format("step {}, time {}", context_.step, time)
                                                       : fmt::format("step {} ({})", context_.step, time));
  }

  Box const& box() const { return context_.simulation.schemes().front()->box(); }

  // The quantity of each ensemble that has it; NaN for the particles of the others.
  std::vector<Values> values(std::string const& name) {
    meaning(ensembles_, name);
    if (needs_influence(name)) refresh_influence();
    Measures measures;
    if (name == "potential-energy") measures = context_.simulation.measure();
    std::vector<Values> all;
    for (std::size_t e = 0; e < ensembles_.size(); ++e) {
      std::span<double const> potential;
      if (e < measures.per_particle.size()) potential = measures.per_particle[e];
      if (has_quantity(*ensembles_[e], name))
        all.push_back(quantity(*ensembles_[e], name, potential));
      else
        all.emplace_back(ensembles_[e]->size(), no_value);
    }
    return all;
  }

  // Classes without a velocity have their influence for it, and an integrator leaves that of an intermediate stage.
  void refresh_influence() {
    if (fresh_) return;
    fresh_ = true;
    for (auto* ensemble : ensembles_) ensemble->clear_influence();
    for (auto* scheme : context_.simulation.schemes()) scheme->add_influences(context_.time);
  }

  static Values joined(std::vector<Values> const& parts) {
    Values all;
    for (auto const& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
  }

  // The part of space that is shown: the box, and on open axes also what has left it, up to half a box away.
  std::vector<std::array<double, 2>> shown_box(std::array<Values, 3> const& position) const {
    std::vector<std::array<double, 2>> sides;
    for (int a = 0; a < box().dimension(); ++a) {
      std::array<double, 2> side{box().low(a), box().high(a)};
      if (box().boundary(a) == Boundary::open)
        for (double const x : position[a])
          if (std::isfinite(x)) side = {std::min(side[0], x), std::max(side[1], x)};
      double const room = box().length(a) / 2;
      side = {std::max(side[0], box().low(a) - room), std::min(side[1], box().high(a) + room)};
      sides.push_back(side);
    }
    return sides;
  }

  Values diameters(std::vector<Values> const& size) const {
    double common = 0;
    for (auto const* ensemble : ensembles_) common = std::max(common, ensemble->appearance.diameter);
    double volume = box().volume();
    std::size_t count = 0;
    for (auto const* ensemble : ensembles_) count += ensemble->size();
    if (common == 0 && count > 0) common = 0.5 * std::pow(volume / static_cast<double>(count), 1.0 / box().dimension());
    double largest = 0;
    for (auto const& part : size)
      for (double const v : part)
        if (std::isfinite(v)) largest = std::max(largest, std::abs(v));
    Values all;
    for (std::size_t e = 0; e < ensembles_.size(); ++e) {
      double const own = ensembles_[e]->appearance.diameter > 0 ? ensembles_[e]->appearance.diameter : common;
      for (std::size_t i = 0; i < ensembles_[e]->size(); ++i)
        all.push_back(size.empty() || !(largest > 0) || std::isnan(size[e][i]) ? own
                                                                               : own * std::abs(size[e][i]) / largest);
    }
    return all;
  }

  bool any_diameter() const {
    return std::any_of(ensembles_.begin(), ensembles_.end(), [](auto* e) { return e->appearance.diameter > 0; });
  }

  Canvas cartesian() {
    int const D = box().dimension();
    if (D == 1) return phase_space("position.x", picture_.colour.empty() ? "" : picture_.colour);
    std::array<Values, 3> position;
    for (int a = 0; a < D; ++a) position[a] = joined(values(std::string("position.") + "xyz"[a]));

    CartesianStyle style;
    style.title = title();
    auto const length = shown_in(dimensions::length);
    style.unit = length.unit;
    style.unit_factor = length.factor;
    std::vector<int> species;
    for (std::size_t e = 0; e < ensembles_.size(); ++e) {
      species.insert(species.end(), ensembles_[e]->size(), static_cast<int>(e));
      if (ensembles_.size() > 1) style.species_names.push_back(ensembles_[e]->name());
      style.species_colours.push_back(colour(static_cast<int>(e)));
    }
    style.species = species;
    Values value;
    if (!picture_.colour.empty()) {
      auto const what = meaning(ensembles_, picture_.colour);
      value = joined(values(picture_.colour));
      style.value = value;
      style.value_name = what.label;
      auto const shown = shown_in(what.dimension);
      style.value_unit = shown.unit;
      style.value_factor = shown.factor;
      style.value_low = picture_.low;
      style.value_high = picture_.high;
      bool const negative = std::any_of(value.begin(), value.end(), [](double v) { return v < 0; });
      bool const positive = std::any_of(value.begin(), value.end(), [](double v) { return v > 0; });
      if (negative && positive) style.map = ColourMap::diverging;
    }
    Values diameter;
    if (!picture_.size.empty() || any_diameter()) {
      diameter = diameters(picture_.size.empty() ? std::vector<Values>{} : values(picture_.size));
      style.diameter = diameter;
    }
    std::vector<Tracks> tracks;
    std::array<Values, 3> reach = position;
    if (picture_.trace) {
      tracks = read_tracks();
      for (auto const& track : tracks)
        for (int a = 0; a < D; ++a) reach[a].insert(reach[a].end(), track.position[a].begin(), track.position[a].end());
    }
    auto const shown = shown_box(reach);
    if (D == 3) style.box = shown;
    for (int a = 0; a < D && D == 2; ++a) style.box.push_back({box().low(a), box().high(a)});
    for (int a = 0; a < D; ++a) style.periodic[a] = box().periodic(a);
    auto const connections = bonds();
    style.connections = connections;
    Canvas canvas = D == 2 ? draw_cartesian(position[0], position[1], style)
                           : draw_cartesian(position[0], position[1], position[2], style);
    if (D == 2) {
      Axis axes[2] = {canvas.x_axis(), canvas.y_axis()};
      for (int a = 0; a < D; ++a) {
        double const margin = 0.03 * (shown[a][1] - shown[a][0]);
        axes[a].low = shown[a][0] - margin;
        axes[a].high = shown[a][1] + margin;
      }
      canvas.axes(axes[0], axes[1]);
    }
    for (auto const& track : tracks) draw_track(canvas, track);
    std::size_t outside = 0;
    for (std::size_t i = 0; i < position[0].size(); ++i)
      for (int a = 0; a < D; ++a)
        if (position[a][i] < shown[a][0] || position[a][i] > shown[a][1]) {
          ++outside;
          break;
        }
    if (outside > 0)
      canvas.note(fmt::format("{} {} far outside the box", outside, outside == 1 ? "particle is" : "particles are"));
    return canvas;
  }

  std::vector<std::array<std::size_t, 2>> bonds() const {
    std::map<AnyEnsemble const*, std::size_t> first;
    std::size_t count = 0;
    for (auto const* ensemble : ensembles_) first[ensemble] = count, count += ensemble->size();
    std::vector<std::array<std::size_t, 2>> all;
    for (auto const* scheme : context_.simulation.schemes())
      if (auto const* pairs = dynamic_cast<PairScheme const*>(scheme))
        for (auto const& bond : pairs->bonds())
          all.push_back({first[bond.ensemble] + bond.i, first[bond.ensemble] + bond.j});
    return all;
  }

  // The way of one particle through all frames.
  struct Tracks {
    int species;
    std::size_t particle;
    std::array<Values, 3> position;
  };

  std::vector<Tracks> read_tracks() const {
    TrajectoryReader const reader(context_.folder + "/trajectory.h5");
    std::vector<Tracks> all;
    int const D = box().dimension();
    for (std::size_t e = 0; e < ensembles_.size(); ++e) {
      std::size_t const first = all.size();
      for (std::size_t f = 0; f < reader.frames(); ++f) {
        if (reader.steps()[f] > context_.step) break;
        auto const frame = reader.read(f, ensembles_[e]->name(), "position");
        std::size_t const count = frame.size() / static_cast<std::size_t>(D);
        while (all.size() < first + count) all.push_back({static_cast<int>(e), all.size() - first, {}});
        for (std::size_t i = 0; i < count; ++i) extend(all[first + i], &frame[i * static_cast<std::size_t>(D)]);
      }
      for (std::size_t i = 0; i < ensembles_[e]->size() && first + i < all.size(); ++i)
        extend(all[first + i], ensembles_[e]->row(i));
    }
    return all;
  }

  // A particle that goes through a periodic wall leaves a gap in its track.
  void extend(Tracks& track, double const* place) const {
    int const D = box().dimension();
    bool jump = false;
    for (int a = 0; a < D; ++a)
      if (box().periodic(a) && !track.position[a].empty())
        jump = jump || std::abs(place[a] - track.position[a].back()) > box().length(a) / 2;
    for (int a = 0; a < D; ++a) {
      if (jump) track.position[a].push_back(no_value);
      track.position[a].push_back(place[a]);
    }
  }

  void draw_track(Canvas& canvas, Tracks const& track) const {
    Colour const colour = track_colour(track.species, track.particle);
    if (box().dimension() == 2) {
      canvas.curve(track.position[0], track.position[1], colour, "", 1.4F);
      return;
    }
    Projection const projection;
    Values right, up;
    for (std::size_t k = 0; k < track.position[0].size(); ++k) {
      auto const place = projection(track.position[0][k], track.position[1][k], track.position[2][k]);
      right.push_back(place.right);
      up.push_back(place.up);
    }
    canvas.curve(right, up, colour, "", 1.4F);
  }

  Canvas phase_space(std::string x, std::string y) {
    if (x.empty()) x = "position.x";
    if (y.empty()) y = "velocity.x";
    auto const mx = meaning(ensembles_, x), my = meaning(ensembles_, y);
    auto const vx = values(x), vy = values(y);
    std::vector<Series> series;
    for (std::size_t e = 0; e < ensembles_.size(); ++e)
      series.push_back({ensembles_.size() > 1 ? ensembles_[e]->name() : "", vx[e], vy[e], colour(static_cast<int>(e))});
    Axis x_axis = axis(mx.label, mx.dimension);
    if (x.starts_with("position.") && box().periodic(x.back() - 'x')) {
      x_axis.low = box().low(x.back() - 'x');
      x_axis.high = box().high(x.back() - 'x');
    }
    Canvas canvas = draw_phase_space(series, x_axis, axis(my.label, my.dimension), title());
    canvas.equal_aspect(x.starts_with("position") && y.starts_with("position"));
    if (picture_.trace) trace(canvas, x, y);
    return canvas;
  }

  // Two quantities of every particle through all frames. The ensembles show one frame after the other meanwhile.
  void trace(Canvas& canvas, std::string const& x, std::string const& y) {
    TrajectoryReader const reader(context_.folder + "/trajectory.h5");
    std::vector<Checkpoint::Rows> now;
    for (auto const* ensemble : ensembles_) now.push_back(copy_rows(*ensemble));
    std::vector<std::vector<std::array<Values, 2>>> tracks(ensembles_.size());
    auto const extend = [&] {
      fresh_ = false;
      auto const vx = values(x), vy = values(y);
      for (std::size_t e = 0; e < ensembles_.size(); ++e) {
        tracks[e].resize(std::max(tracks[e].size(), vx[e].size()));
        for (std::size_t i = 0; i < vx[e].size(); ++i) {
          auto& [tx, ty] = tracks[e][i];
          bool const jump =
              !tx.empty() && (through_wall(x, vx[e][i] - tx.back()) || through_wall(y, vy[e][i] - ty.back()));
          if (jump) tx.push_back(no_value), ty.push_back(no_value);
          tx.push_back(vx[e][i]);
          ty.push_back(vy[e][i]);
        }
      }
    };
    for (std::size_t f = 0; f < reader.frames() && reader.steps()[f] < context_.step; ++f) {
      for (auto* ensemble : ensembles_) reader.load(f, *ensemble);
      extend();
    }
    for (std::size_t e = 0; e < ensembles_.size(); ++e) restore_rows(now[e], *ensembles_[e]);
    extend();
    for (std::size_t e = 0; e < tracks.size(); ++e)
      for (std::size_t i = 0; i < tracks[e].size(); ++i)
        canvas.curve(tracks[e][i][0], tracks[e][i][1], track_colour(static_cast<int>(e), i), "", 1.4F);
  }

  bool through_wall(std::string const& name, double way) const {
    if (!name.starts_with("position.")) return false;
    int const axis = name.back() - 'x';
    return box().periodic(axis) && std::abs(way) > box().length(axis) / 2;
  }

  // Few particles get a colour each, many that of their ensemble.
  Colour track_colour(int ensemble, std::size_t particle) const {
    bool const few = ensembles_.size() == 1 && ensembles_[0]->size() <= 8;
    return with_alpha(few ? species_colour(static_cast<int>(particle)) : colour(ensemble), 0.7);
  }

  Canvas spectrum_in_space() {
    std::string const x = picture_.x.empty() ? "position.x" : picture_.x;
    std::string const y = picture_.y.empty() ? "velocity.x" : picture_.y;
    auto const mx = meaning(ensembles_, x), my = meaning(ensembles_, y);
    check_spectrum_axis(x);
    if (needs_influence(y)) refresh_influence();
    for (auto const* ensemble : ensembles_) {
      if (!has_quantity(*ensemble, y)) continue;
      auto const spectrum = spectrum_of(*ensemble, y, x.back() - 'x');
      return draw_spectrum(spectrum.frequency, spectrum.density,
                           axis("wave number / 2π", dimensions::none / mx.dimension),
                           axis("power of " + my.label, my.dimension * my.dimension * mx.dimension), true, title());
    }
    throw Error("no particles with '" + y + "' to draw a spectrum of");
  }

  CsvTable table() const {
    auto table = read_csv(context_.folder + "/diagnoses.csv");
    std::size_t rows = table.columns.empty() ? 0 : table.columns[0].size();
    while (rows > 0 && table.columns[0][rows - 1] > static_cast<double>(context_.step)) --rows;
    for (auto& column : table.columns) column.resize(rows);
    return table;
  }

  // The columns of a table that were asked for; none: all of the unit of the first one.
  std::vector<std::size_t> chosen(CsvTable const& table) const {
    std::vector<std::string> names;
    for (std::size_t c = 2; c < table.header.size(); ++c) names.push_back(heading(table.header[c]).name);
    std::vector<std::size_t> columns;
    for (auto const& word : split(picture_.y)) {
      auto const found = std::find(names.begin(), names.end(), word);
      if (found == names.end())
        throw Error("diagnoses.csv has no column '" + word + "'; it has " + join(names) + did_you_mean(word, names));
      columns.push_back(2 + static_cast<std::size_t>(found - names.begin()));
    }
    if (columns.empty())
      for (std::size_t c = 2; c < table.header.size(); ++c)
        if (heading(table.header[c]).unit == heading(table.header[2]).unit) columns.push_back(c);
    if (columns.empty()) throw Error("diagnoses.csv has no column to draw");
    return columns;
  }

  Canvas time_series() const {
    auto const data = table();
    auto const columns = chosen(data);
    std::string const common = heading(data.header[columns[0]]).unit;
    bool const same =
        std::all_of(columns.begin(), columns.end(), [&](auto c) { return heading(data.header[c]).unit == common; });
    std::vector<Series> series;
    series.reserve(columns.size());
    for (auto const c : columns)
      series.push_back({columns.size() == 1 ? ""
                        : same              ? heading(data.header[c]).name
                                            : data.header[c],
                        data.columns[1],
                        data.columns[c],
                        {}});
    std::string const label = columns.size() == 1 ? heading(data.header[columns[0]]).name : "";
    Axis y{label, same ? common : ""};
    y.logarithmic = picture_.logarithmic;
    if (y.logarithmic) {  // a value that is zero but for rounding must not press all others together
      double least = std::numeric_limits<double>::infinity(), largest = 0;
      for (auto const& one : series)
        for (double const v : one.y)
          if (v > 0 && std::isfinite(v)) least = std::min(least, v), largest = std::max(largest, v);
      if (least < 1e-12 * largest) y.low = 1e-12 * largest;
    }
    return draw_time_series(series, {"time", heading(data.header[1]).unit}, y, title(false));
  }

  Canvas profiles() const {
    int const D = box().dimension(), a = profile_axis(picture_, D);
    Measures const measures = context_.simulation.measure();
    double const k = context_.base.is_reduced() ? 1 : context_.base(constants::boltzmann);
    Bodies const bodies(ensembles_, &measures);
    std::size_t number = 0;
    for (auto const& source : bodies.sources()) number += source.ensemble->size();
    if (number == 0) return too_few("a profile needs particles with a mass and a velocity");
    auto const bins = std::clamp<std::size_t>(number / 50, 1, static_cast<std::size_t>(picture_.cells));
    auto const [low, high] = extent(bodies, box(), a);
    Profile const found = profile(bodies, box(), a, low, high, bins, k);

    std::vector<ProfileQuantity> meanings;
    for (auto const& name : profile_names(picture_)) meanings.push_back(profile_quantity(D, name));
    bool const one = meanings.size() == 1;
    bool const same = std::all_of(meanings.begin(), meanings.end(),
                                  [&](auto const& m) { return m.dimension == meanings[0].dimension; });
    // Of different dimensions each in its own unit.
    std::vector<Values> values;
    std::vector<Series> series;
    for (auto const& what : meanings) {
      values.push_back(found.values(what.name));
      auto const shown = shown_in(what.dimension);
      if (!same)
        for (double& v : values.back()) v *= shown.factor;
      bool const with_unit = !same && !shown.unit.empty();
      series.push_back({one ? "" : with_unit ? what.label + " (" + shown.unit + ")" : what.label, {}, {}, {}});
    }
    for (std::size_t s = 0; s < series.size(); ++s) series[s].x = found.position, series[s].y = values[s];
    Axis x = axis(std::string(1, "xyz"[a]), dimensions::length);
    x.low = low, x.high = high;
    Axis y = same ? axis(one ? meanings[0].label : "", meanings[0].dimension) : Axis{};
    y.low = picture_.low, y.high = picture_.high, y.logarithmic = picture_.logarithmic;
    return draw_profile(series, x, y, title());
  }

  // A run that was stopped early is no reason to fail: the picture says why it is empty.
  Canvas too_few(std::string const& why) const {
    Canvas canvas;
    canvas.title(title(false));
    canvas.note(why);
    return canvas;
  }

  Canvas spectrum_in_time() const {
    auto const data = table();
    auto const column = chosen(data)[0];
    auto const& time = data.columns[1];
    if (time.size() < 2) return too_few("a spectrum over time needs 2 or more rows of diagnoses.csv");
    double const spacing = (time.back() - time.front()) / static_cast<double>(time.size() - 1);
    auto const spectrum = power_spectrum(data.columns[column], spacing, SpectrumMethod::welch, true);
    std::string const unit = heading(data.header[1]).unit;
    return draw_spectrum(spectrum.frequency, spectrum.density, {"frequency", unit.empty() ? "" : "1/" + unit},
                         {"power of " + heading(data.header[column]).name, ""}, true, title(false));
  }

  // An axis of a mesh: its nodes are the middles of the cells of a picture.
  Axis mesh_axis(MeshGrid const& grid, int a) const {
    Axis result = axis(std::string(1, "xyz"[a]), dimensions::length);
    result.low = grid.position(a, 0) - 0.5 * grid.spacing[a];
    result.high = grid.position(a, grid.nodes[a] - 1) + 0.5 * grid.spacing[a];
    return result;
  }

  Canvas mesh() {
    std::vector<MeshField const*> fields;
    for (auto* scheme : context_.simulation.schemes())
      for (auto const* field : scheme->mesh_fields()) fields.push_back(field);
    MeshQuantity const quantity = mesh_quantity(fields, mesh_name(picture_));
    MeshGrid const& grid = quantity.grid();
    auto const [unit, factor] = shown_in(quantity.dimension());
    if (grid.dimension == 1) {
      Values x;
      for (std::size_t i = 0; i < grid.nodes[0]; ++i) x.push_back(grid.position(0, i));
      Series const curve{"", x, quantity.values()};
      Axis y = axis(quantity.label, quantity.dimension());
      y.low = picture_.low, y.high = picture_.high;
      return draw_time_series({&curve, 1}, axis("x", dimensions::length), y, title());
    }
    int const normal = grid.dimension == 3 ? picture_.slice[0] - 'x' : 2;
    int const right = normal == 0 ? 1 : 0, up = normal == 2 ? 1 : 2;
    double const middle = grid.low[normal] + 0.5 * static_cast<double>(grid.cells(normal)) * grid.spacing[normal];
    double const at = std::isnan(picture_.at) ? middle : picture_.at;
    double const place = std::round((at - grid.low[normal]) / grid.spacing[normal]);
    auto const slice =
        grid.dimension == 3
            ? static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(grid.nodes[normal] - 1)))
            : 0;
    Values shown;
    for (std::size_t row = 0; row < grid.nodes[up]; ++row)
      for (std::size_t column = 0; column < grid.nodes[right]; ++column) {
        std::array<std::size_t, 3> node{};
        node[right] = column, node[up] = row, node[normal] = slice;
        shown.push_back(quantity.values()[grid.index(node[0], node[1], node[2])]);
      }
    Canvas canvas = draw_field(static_cast<int>(grid.nodes[right]), static_cast<int>(grid.nodes[up]), shown,
                               mesh_axis(grid, right), mesh_axis(grid, up), quantity.label, unit, fitting_map(shown),
                               title(), {picture_.low, picture_.high, factor});
    if (grid.dimension == 3)
      canvas.note(fmt::format("slice at {} = {}", "xyz"[normal],
                              quantity_text(grid.position(normal, slice), dimensions::length, context_.base, 4)));
    return canvas;
  }

  // The ensembles that have the quantity of a smooth field; all have a density.
  std::vector<AnyEnsemble*> ensembles_with(std::string const& name) const {
    std::vector<AnyEnsemble*> all;
    if (name != "density") meaning(ensembles_, name);
    for (auto* ensemble : ensembles_)
      if (name == "density" || has_quantity(*ensemble, name)) all.push_back(ensemble);
    return all;
  }

  SmoothColumn smooth_column(SmoothField const& field, std::string const& name) {
    if (name == "potential-energy") return {joined(values(name))};
    if (needs_influence(name)) refresh_influence();
    return field.column(name);
  }

  // The grid of a picture: its first two axes are those of the picture. Nodes are the middles of its cells, or its
  // corners, so that contours end at the walls.
  MeshGrid picture_grid(std::vector<std::array<double, 2>> const& shown, std::array<int, 2> const& axes,
                        bool corners) const {
    MeshGrid grid;
    grid.dimension = static_cast<int>(std::min<std::size_t>(shown.size(), 2));
    double longest = 0;
    for (int k = 0; k < grid.dimension; ++k) longest = std::max(longest, shown[axes[k]][1] - shown[axes[k]][0]);
    for (int k = 0; k < grid.dimension; ++k) {
      auto const [low, high] = shown[axes[k]];
      double const cells = std::max(2.0, std::round(picture_.cells * (high - low) / longest));
      grid.spacing[k] = (high - low) / cells;
      grid.periodic[k] = box().periodic(axes[k]);
      grid.low[k] = corners ? low : low + grid.spacing[k] / 2;
      grid.nodes[k] = static_cast<std::size_t>(cells) + (corners && !grid.periodic[k] ? 1 : 0);
    }
    return grid;
  }

  Canvas smooth_field() {
    std::string const name = picture_.y.empty() ? "density" : picture_.y;
    auto const of = ensembles_with(name);
    Smoothing smoothing = picture_.smoothing;
    bool const own = std::all_of(of.begin(), of.end(), [](auto* e) { return e->find_field("range") != nullptr; });
    if (smoothing.range == 0 && !own) smoothing.range = fitting_range(of, box());
    SmoothField const field(of, box(), smoothing);
    auto const what = field.meaning(name);
    auto const [unit, factor] = shown_in(what.dimension);

    int const D = box().dimension();
    std::array<Values, 3> position;
    for (int a = 0; a < D; ++a) position[a] = joined(values(std::string("position.") + "xyz"[a]));
    auto const shown = shown_box(position);
    int const normal = D == 3 ? picture_.slice[0] - 'x' : 2;
    std::array<int, 2> const axes{normal == 0 ? 1 : 0, normal == 2 ? 1 : 2};
    double const at = D == 3 && std::isnan(picture_.at) ? 0.5 * (box().low(normal) + box().high(normal)) : picture_.at;
    MeshGrid const grid = picture_grid(shown, axes, D == 1 || picture_.drawing == "contours");
    Values points;
    auto const on_plane = points_on_grid(grid);
    for (std::size_t p = 0; p < grid.size(); ++p)
      for (int a = 0; a < D; ++a)
        points.push_back(a == normal ? at
                                     : on_plane[p * static_cast<std::size_t>(grid.dimension) + (a == axes[0] ? 0 : 1)]);
    Values const found =
        (name == "density" ? field.density(points) : field.value(points, smooth_column(field, name))).value;

    auto const along = [&](int k) {
      Axis result = axis(std::string(1, "xyz"[axes[k]]), dimensions::length);
      result.low = shown[axes[k]][0];
      result.high = shown[axes[k]][1];
      return result;
    };
    if (D == 1) {
      Series const curve{"", on_plane, found};
      Axis y = axis(what.label, what.dimension);
      y.low = picture_.low, y.high = picture_.high;
      return draw_time_series({&curve, 1}, along(0), y, title());
    }
    bool const given = std::isfinite(picture_.low) && std::isfinite(picture_.high);
    auto levels = picture_.levels;
    if (levels.empty() && picture_.level_count == 0 && picture_.drawing == "bands") levels = {mean_value(found)};
    if (levels.empty())
      levels = even_levels(given ? Values{picture_.low, picture_.high} : found,
                           picture_.level_count == 0 ? 8 : static_cast<std::size_t>(picture_.level_count));
    auto const columns = static_cast<int>(grid.nodes[0]), rows = static_cast<int>(grid.nodes[1]);
    ColourEnds const ends{picture_.low, picture_.high, factor};
    Canvas canvas = [&, unit = unit, factor = factor] {
      if (picture_.drawing == "contours")
        return draw_contours(grid, found, levels, along(0), along(1), what.label, unit, title(), ends);
      if (picture_.drawing == "bands")
        return draw_bands(columns, rows, found, levels, along(0), along(1), what.label, unit, title(), factor);
      return draw_field(columns, rows, found, along(0), along(1), what.label, unit, fitting_map(found), title(), ends);
    }();
    if (D == 3)
      canvas.note(
          fmt::format("slice at {} = {}", "xyz"[normal], quantity_text(at, dimensions::length, context_.base, 4)));
    return canvas;
  }

  // Blue and red for values of both signs. Ends that are given decide for all frames of a movie.
  ColourMap fitting_map(Values const& shown) const {
    bool const negative = std::isfinite(picture_.low)
                              ? picture_.low < 0
                              : std::any_of(shown.begin(), shown.end(), [](double v) { return v < 0; });
    bool const positive = std::isfinite(picture_.high)
                              ? picture_.high > 0
                              : std::any_of(shown.begin(), shown.end(), [](double v) { return v > 0; });
    return negative && positive ? ColourMap::diverging : ColourMap::viridis;
  }

  // Power over wave number and frequency; colours by its logarithm, over six decades.
  Canvas wave_spectrum() const {
    WaveSpectrum const& waves = recorded_waves(context_.diagnoses, picture_.y);
    if (!waves.enough()) return too_few(fmt::format("a wave spectrum needs 4 or more looks, not {}", waves.looks()));
    WavePower const spectrum = waves.power();
    auto const& k = spectrum.wave_number;
    auto const& omega = spectrum.frequency;
    double largest = 0;
    for (double const p : spectrum.power) largest = std::max(largest, p);
    Values decades;
    for (double const p : spectrum.power)
      decades.push_back(largest > 0 ? std::max(-6.0, std::log10(p / largest)) : no_value);
    double const dk = k.size() > 1 ? k[1] - k[0] : 1, half = 0.5 * omega[1];
    Axis x = axis(std::string("wave number k_{") + "xyz"[waves.axis()] + "}", dimensions::wave_number);
    Axis y = axis("ω", dimensions::frequency);
    x.low = k.front() - 0.5 * dk, x.high = k.back() + 0.5 * dk;
    y.low = -half, y.high = omega.back() + half;
    std::string label = waves.quantity();
    if (auto const dot = label.rfind('.'); dot != std::string::npos) label[dot] = ' ';
    Canvas canvas =
        draw_field(static_cast<int>(k.size()), static_cast<int>(omega.size()), decades, x, y,
                   "log_{10} power of " + label + ", the largest is 0", "", ColourMap::viridis, title(false));
    canvas.equal_aspect(false);
    for (auto const& dispersion : picture_.curves) {
      Values right, up;
      for (int i = 0; i <= 200; ++i) {
        double const at = x.low + (x.high - x.low) * i / 200;
        double const frequency = std::hypot(dispersion.frequency, dispersion.speed * at);
        right.push_back(at);
        up.push_back(frequency <= y.high ? frequency : no_value);
      }
      canvas.curve(right, up, colour_named("white"), "", 2, true);
    }
    return canvas;
  }

  Picture const& picture_;
  PictureContext const& context_;
  std::vector<AnyEnsemble*> ensembles_;
  bool fresh_ = false;
};

void check_drawing(Picture const& picture) {
  auto const& names = drawing_names();
  if (std::find(names.begin(), names.end(), picture.drawing) == names.end())
    throw Error("unknown drawing '" + picture.drawing + "'; there are " + join(names) +
                did_you_mean(picture.drawing, names));
}

void check_smooth_field(Picture const& picture, std::vector<AnyEnsemble*> const& ensembles) {
  if (picture.y != "density" && !picture.y.empty()) meaning(ensembles, picture.y);
  if (picture.drawing != "map" && !ensembles.empty() && ensembles.front()->dimension() == 1)
    throw Error("'" + picture.drawing + "' are drawn in 2D and 3D; in 1D 'map' draws a curve");
  if (!(picture.smoothing.range >= 0) || std::isinf(picture.smoothing.range))
    throw Error(fmt::format("the range of a smooth field must be above 0, it is {}", picture.smoothing.range));
  if (!std::all_of(picture.levels.begin(), picture.levels.end(), [](double v) { return std::isfinite(v); }) ||
      !std::is_sorted(picture.levels.begin(), picture.levels.end()))
    throw Error("the levels of contours and bands must be finite and ascend");
  if (picture.level_count < 0 || picture.level_count > 1000)
    throw Error(fmt::format("a picture has 1 to 1000 levels, not {}", picture.level_count));
  if (picture.cells < 2 || picture.cells > 4000)
    throw Error(fmt::format("the grid of a picture has 2 to 4000 cells along a side, not {}", picture.cells));
}

}  // namespace

std::vector<std::string> const& drawing_names() {
  static std::vector<std::string> const names{"cartesian", "phase-space",   "spectrum", "time-series", "profile",
                                              "mesh",      "wave-spectrum", "map",      "contours",    "bands"};
  return names;
}

void check_tracks(Simulation const& simulation) {
  if (!simulation.adaptations().empty())
    throw Error("a picture with tracks needs particles that keep their numbers; here some come and go between steps");
}

Canvas draw(Picture const& picture, PictureContext const& context) {
  check_drawing(picture);
  if (picture.trace) check_tracks(context.simulation);
  return Drawer(picture, context).draw();
}

void check(Picture const& picture, std::vector<AnyEnsemble*> const& ensembles, std::vector<std::string> const& columns,
           PictureSources const& sources) {
  check_drawing(picture);
  auto const dot = picture.file.rfind('.');
  std::string const extension = dot == std::string::npos ? "" : picture.file.substr(dot);
  if (extension != ".png" && extension != ".svg" && extension != ".pdf")
    throw Error("the picture '" + picture.file + "' ends in none of .png, .svg, .pdf");
  if (picture.file.find('/') != std::string::npos)
    throw Error("the picture '" + picture.file + "' is a name in the run's folder, without '/'");
  auto const known = [&](std::string const& name) {
    if (!name.empty()) meaning(ensembles, name);
  };
  known(picture.colour);
  known(picture.size);
  if (picture.drawing == "phase-space") known(picture.x), known(picture.y);
  if (picture.drawing == "profile" && !ensembles.empty()) {
    int const D = ensembles.front()->dimension();
    profile_axis(picture, D);
    for (auto const& name : profile_names(picture)) profile_quantity(D, name);
    if (picture.cells < 1) throw Error(fmt::format("a profile has one bin or more, not {}", picture.cells));
  }
  if (picture.drawing == "spectrum" && picture.x != "time") {
    if (!picture.x.empty()) check_spectrum_axis(picture.x);
    known(picture.x), known(picture.y);
  }
  if (picture.drawing == "mesh") mesh_quantity(sources.mesh_fields, mesh_name(picture));
  if ((picture.drawing == "mesh" || of_smooth_field(picture)) && picture.slice != "x" && picture.slice != "y" &&
      picture.slice != "z")
    throw Error("a slice is normal to x, y or z, not '" + picture.slice + "'");
  if (of_smooth_field(picture)) check_smooth_field(picture, ensembles);
  if (picture.drawing == "wave-spectrum") recorded_waves(sources.diagnoses, picture.y);
  if (picture.drawing == "time-series" || (picture.drawing == "spectrum" && picture.x == "time")) {
    if (columns.empty()) throw Error("a picture over time needs diagnoses, and none are recorded");
    for (auto const& word : split(picture.y))
      if (std::find(columns.begin(), columns.end(), word) == columns.end())
        throw Error("no diagnosis gives a column '" + word + "'; there are " + join(columns) +
                    did_you_mean(word, columns));
  }
}

}  // namespace boltzmann
