// Computes the sheet from velocities on panels, and its velocity at advected particles.
#include <boltzmann/core/error.hpp>
#include <boltzmann/schemes/panels/panel_kernels.hpp>
#include <boltzmann/schemes/panels/panel_scheme.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {

PanelScheme::PanelScheme(Box box) : Scheme(box) {
  if (box.dimension() != 2)
    throw Error(fmt::format("bodies: panels are lines around bodies in 2D; the box has {} dimension{}", box.dimension(),
                            box.dimension() == 1 ? "" : "s"));
  for (int a = 0; a < 2; ++a)
    if (box.periodic(a) || box.boundary(a) == Boundary::mirror)
      throw Error(fmt::format("bodies: axis {} is {}, where the sheet would need images; make it open", "xy"[a],
                              box.periodic(a) ? "periodic" : "mirror"));
}

void PanelScheme::add_body(Ensemble<Panel<2>>& body, Outline const& outline, BodySheet const& sheet) {
  std::size_t const first = sheet_.panels().size();
  sheet_.add(outline, sheet.circulation, sheet.kutta);
  body.resize(sheet_.panels().size() - first);
  double length = 0;
  for (std::size_t i = 0; i < body.size(); ++i) {
    auto const& panel = sheet_.panels()[first + i];
    body[i].position = panel.middle();
    body[i].normal = panel.normal();
    body[i].length = panel.length;
    length += panel.length;
  }
  if (body.appearance.diameter == 0) body.appearance.diameter = length / static_cast<double>(body.size());
  Scheme::add(body);
  bodies_.push_back(&body);
  normal_velocity_.resize(sheet_.panels().size());
}

void PanelScheme::add(AnyEnsemble& ensemble) {
  if (ensemble.find_field("velocity") || ensemble.find_field("mass") || ensemble.influence_size() < 2)
    throw Error(fmt::format("bodies: class {} of '{}' is not carried by a flow; tracers and vortices are",
                            ensemble.class_name(), ensemble.name()));
  Scheme::add(ensemble);
  if (std::find(carried_.begin(), carried_.end(), &ensemble) == carried_.end()) carried_.push_back(&ensemble);
}

void PanelScheme::find_sheet() {
  if (division_) {
    division_->team().meet(Team::Occasion::exchanges);
    for (auto* body : bodies_)
      division_->gather(*body, body->influence(0), body->influence_size(), body->influence_size());
  }
  std::size_t at = 0;
  for (auto* body : bodies_)
    for (std::size_t i = 0; i < body->size(); ++i, ++at) {
      double const *row = body->row(i), *velocity = body->influence(i);
      auto const& panel = sheet_.panels()[at];
      if (!(magnitude(Vector<2>{row[0], row[1]} - panel.middle()) <= 1e-6 * panel.length))
        throw PhysicsFailure(fmt::format("panel {} of '{}' has moved; bodies must not move", i, body->name()));
      auto const normal = panel.normal();
      normal_velocity_[at] = velocity[0] * normal[0] + velocity[1] * normal[1];
      if (!std::isfinite(normal_velocity_[at]))
        throw PhysicsFailure(
            fmt::format("the velocity of the flow on panel {} of '{}' is not finite", i, body->name()));
    }
  if (at == 0) return;
  sheet_.solve(normal_velocity_);
  auto const& strengths = sheet_.strengths();
  at = 0;
  for (auto* body : bodies_) {
    auto const sheet = static_cast<std::size_t>(body->field("sheet").offset);
    for (std::size_t i = 0; i < body->size(); ++i, ++at) {
      auto const& panel = sheet_.panels()[at];
      body->row(i)[sheet] = 0.5 * (strengths[panel.first] + strengths[panel.second]);
    }
  }
}

void PanelScheme::carry(AnyEnsemble& ensemble) {
  std::vector<Stretch> const everybody{{0, ensemble.size()}};
  auto const& own = ensemble.share() ? ensemble.share()->stretches : everybody;
  auto const over_own = [&](auto const& function) {
    std::size_t at = 0;
    for (auto const& [begin, end] : own)
      for (std::size_t i = begin; i < end; ++i) function(i, at++);
  };
  std::size_t const count = ensemble.share() ? ensemble.share()->size : ensemble.size();
  for (auto* array : {&x_, &y_, &u_, &v_}) array->resize(std::max(array->size(), count + places_padding));
  over_own([&](std::size_t i, std::size_t at) {
    x_[at] = ensemble.row(i)[0], y_[at] = ensemble.row(i)[1];
    if (!std::isfinite(x_[at]) || !std::isfinite(y_[at]))
      throw PhysicsFailure(fmt::format("the position of particle {} of '{}' is not finite", i, ensemble.name()));
  });
  std::fill_n(u_.begin(), count + places_padding, 0.0);
  std::fill_n(v_.begin(), count + places_padding, 0.0);
  sheet_.add_velocities(x_.data(), y_.data(), u_.data(), v_.data(), count, threads());
  over_own([&](std::size_t i, std::size_t at) {
    double* const influence = ensemble.influence(i);
    influence[0] += u_[at], influence[1] += v_[at];
  });
}

void PanelScheme::add_influences(double /*time*/) {
  find_sheet();
  for (auto* ensemble : carried_) carry(*ensemble);
}

void PanelScheme::add_stream(std::span<double const> places, double /*time*/, std::span<double> velocities) {
  std::size_t const count = places.size() / 2;
  std::vector<double> x(count + places_padding), y(x), u(x), v(x);
  for (std::size_t i = 0; i < count; ++i) x[i] = places[2 * i], y[i] = places[2 * i + 1];
  sheet_.add_velocities(x.data(), y.data(), u.data(), v.data(), count, threads());
  for (std::size_t i = 0; i < count; ++i) velocities[2 * i] += u[i], velocities[2 * i + 1] += v[i];
}

EnergyAndVirial PanelScheme::measure(double /*time*/) {
  EnergyAndVirial measures;
  measures.unknown = "the vortex sheet of a body";
  measures.no_virial = "vortex sheets have no forces between particles";
  return measures;
}

void PanelScheme::make_reversible(double /*quantum*/) {
  throw Error("bodies of panels can't be reversed: the solution of their equations is rounded");
}

std::size_t PanelScheme::bytes() const {
  return sheet_.bytes() + 4 * x_.capacity() * sizeof(double) + normal_velocity_.capacity() * sizeof(double);
}

std::string PanelScheme::summary() const {
  return fmt::format("{} bod{} of {} panels", bodies_.size(), bodies_.size() == 1 ? "y" : "ies",
                     sheet_.panels().size());
}

}  // namespace boltzmann
