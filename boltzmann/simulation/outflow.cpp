// Finds particles beyond a plane, and records what they carry.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/number.hpp>
#include <boltzmann/simulation/outflow.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace boltzmann {

void OutflowPlane::check(int dimension) const {
  if (!from) throw Error("outflow: the place is missing; add e.g. from = [10, 0]");
  if (!direction) throw Error("outflow: the direction is missing; add e.g. direction = [1, 0]");
  double length = 0;
  for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
    if (!std::isfinite((*from)[a]) || !std::isfinite((*direction)[a]))
      throw Error("outflow: a place or a direction is not finite");
    length = std::hypot(length, (*direction)[a]);
  }
  if (!(length > 0)) throw Error("outflow: the direction is zero; one of its numbers must differ from 0");
}

bool OutflowPlane::beyond(double const* place, int dimension) const {
  double along = 0;
  for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a)
    along += (place[a] - (*from)[a]) * (*direction)[a];
  return along > 0;
}

Outflow::Outflow(AnyEnsemble& ensemble, Box const& box, OutflowPlane const& plane, OutflowInto const& to)
    : ensemble_(&ensemble), plane_(plane), to_(to) {
  if (ensemble.find_field("velocity") || ensemble.find_field("mass") || ensemble.influence_size() == 0)
    throw Error(
        fmt::format("outflow: '{}' is of class {}, which no flow carries; tracers and vortices leave with a flow",
                    ensemble.name(), ensemble.class_name()));
  plane_.check(box.dimension());
  if (!to.into) return;
  if (to.into == &ensemble) throw Error(fmt::format("outflow: '{}' can't leave into itself", ensemble.name()));
  for (AnyEnsemble const* one : {static_cast<AnyEnsemble const*>(&ensemble), static_cast<AnyEnsemble const*>(to.into)})
    if (!one->find_field("vorticity"))
      throw Error(fmt::format("outflow: '{}' is of class {}; only vortices become part of another ensemble of vortices",
                              one->name(), one->class_name()));
  if (to.into->size() == 0)
    throw Error(fmt::format("outflow: '{}' needs a particle as an example of those that enter it", to.into->name()));
}

/// Adds the contribution of one particle.
void Outflow::leave(double const* row) {
  Field const* const vorticity = ensemble_->find_field("vorticity");
  if (!vorticity) return;
  int const dimension = ensemble_->dimension();
  Vector<3> place{}, strength{};
  for (int a = 0; a < dimension; ++a) place[a] = row[a];
  for (int k = 0; k < vorticity->components; ++k)
    strength[vorticity->components == 1 ? 2 : k] = row[vorticity->offset + k];
  vorticity_ += strength;
  impulse_ += cross(place, strength) * (dimension == 2 ? 1 : 0.5);
  if (!to_.bodies || dimension != 2) return;
  auto const& panels = to_.bodies->sheet().panels();
  normal_velocity_.resize(panels.size());
  for (std::size_t k = 0; k < panels.size(); ++k) {
    auto const middle = panels[k].middle(), normal = panels[k].normal();
    double const x = middle[0] - place[0], y = middle[1] - place[1];
    normal_velocity_[k] += strength[2] / (2 * pi * (x * x + y * y)) * (x * normal[1] - y * normal[0]);
  }
}

/// Adds a particle to the destination ensemble.
void Outflow::enter(double const* row) {
  AnyEnsemble& into = *to_.into;
  std::size_t const at = into.size();
  into.resize(at + 1);
  if (at > 0) std::copy_n(into.row(0), into.doubles(), into.row(at));
  for (auto const& field : into.fields())
    if (Field const* const same = ensemble_->find_field(field.name); same && same->components == field.components)
      std::copy_n(row + same->offset, field.components, into.row(at) + field.offset);
}

void Outflow::change() {
  int const dimension = ensemble_->dimension();
  std::size_t const count = ensemble_->size(), doubles = ensemble_->doubles();
  std::size_t stay = 0;
  std::fill(normal_velocity_.begin(), normal_velocity_.end(), 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    double const* const row = ensemble_->row(i);
    if (plane_.beyond(row, dimension)) {
      if (to_.into)
        enter(row);
      else
        leave(row);
      continue;
    }
    if (stay != i) std::copy_n(row, doubles, ensemble_->row(stay));
    ++stay;
  }
  if (stay == count) return;
  left_ += count - stay;
  if (!normal_velocity_.empty()) sheet_impulse_ += to_.bodies->sheet().added_impulse(normal_velocity_);
  ensemble_->resize(stay);
  ensemble_->clear_influence();
  if (to_.into) to_.into->clear_influence();
}

std::string Outflow::report(UnitSystem const& units) const {
  if (left_ == 0) return "";
  if (to_.into)
    return fmt::format("'{}': {} {} gone over to '{}', {} stay", ensemble_->name(), left_, left_ == 1 ? "has" : "have",
                       to_.into->name(), ensemble_->size());
  std::string line = fmt::format("'{}': {} {} left with the flow, {} stay", ensemble_->name(), left_,
                                 left_ == 1 ? "has" : "have", ensemble_->size());
  if (!ensemble_->find_field("vorticity")) return line;
  using namespace dimensions;
  bool const plane = ensemble_->dimension() == 2;
  Dimension const strength = plane ? circulation : circulation * length;
  line += fmt::format("; {} {}, impulse {}, {}", plane ? "circulation" : "vorticity",
                      units.text(plane ? vorticity_[2] : magnitude(vorticity_), strength),
                      units.text(impulse_[0], strength * length), units.text(impulse_[1], strength * length));
  return plane ? line : line + ", " + units.text(impulse_[2], strength * length);
}

FlowImpulse Outflow::taken() const {
  if (ensemble_->dimension() != 2) return {};
  return {{impulse_[0] + sheet_impulse_[0], impulse_[1] + sheet_impulse_[1]}, vorticity_[2]};
}

std::vector<double> Outflow::state() const {
  return {
      static_cast<double>(left_), vorticity_[0],    vorticity_[1], vorticity_[2], impulse_[0], impulse_[1], impulse_[2],
      sheet_impulse_[0],          sheet_impulse_[1]};
}

void Outflow::restore(std::span<double const> state) {
  if (state.size() != 9) throw Error("the checkpoint does not fit this simulation: it has no outflow");
  left_ = static_cast<std::size_t>(state[0]);
  vorticity_ = {state[1], state[2], state[3]};
  impulse_ = {state[4], state[5], state[6]};
  sheet_impulse_ = {state[7], state[8]};
}

OptionTable const& outflow_options() {
  using namespace option;
  static OptionTable const all = [] {
    using O = OutflowOptions;
    OptionTable table;
    table.add("every", &O::every, whole(1, std::numeric_limits<double>::infinity()), "steps between removals");
    table.add_said("on", ensembles(), "ensembles that leave", "all tracers and vortices");
    table.add("from", &O::how, &OutflowPlane::from, vector(dimensions::length),
              "a point of the plane beyond which particles are removed");
    table.add("direction", &O::how, &OutflowPlane::direction, vector(dimensions::none),
              "direction across the plane, downstream, of any length");
    table.add_said(
        "into", text("the name of an ensemble"),
        "ensemble of vortices that receives the particles instead: a wake that is remeshed on a wider lattice",
        "removed");
    table.at("from").needed = "[10, 0]";
    table.at("direction").needed = "[1, 0]";
    return table;
  }();
  return all;
}

}  // namespace boltzmann
