// Converts sheets to vortices.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/number.hpp>
#include <boltzmann/simulation/no_slip.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace boltzmann {

NoSlip::NoSlip(PanelScheme& bodies, AnyEnsemble& vortices, std::vector<std::size_t> which, double interval)
    : bodies_(&bodies), vortices_(&vortices), which_(std::move(which)), interval_(interval) {
  auto const& carried = bodies.carried();
  if (std::find(carried.begin(), carried.end(), &vortices) == carried.end())
    throw Error(fmt::format("no_slip: '{}' does not move with the flow around the bodies", vortices.name()));
  if (!vortices.find_field("vorticity") || !vortices.find_field("viscosity"))
    throw Error(
        fmt::format("no_slip: class {} of '{}' has no vorticity or no viscosity, by which it could spread; class "
                    "Diffusive has both",
                    vortices.class_name(), vortices.name()));
  if (vortices.size() == 0 || !(vortices.row(0)[vortices.field("viscosity").offset] > 0))
    throw Error(
        fmt::format("no_slip: '{}' needs a particle, with a viscosity above zero, as an example of those that "
                    "bodies shed",
                    vortices.name()));
}

void NoSlip::change() {
  auto const& sheet = bodies_->sheet();
  std::size_t const begin = vortices_->size();
  if (begin == 0)
    throw PhysicsFailure(fmt::format(
        "no_slip: no particle is left in '{}' as a template for the vortices that walls shed", vortices_->name()));
  std::size_t count = 0, first_panel = 0;
  for (std::size_t b = 0; b < bodies_->bodies().size(); ++b)
    if (std::find(which_.begin(), which_.end(), b) != which_.end()) count += bodies_->bodies()[b]->size();
  vortices_->resize(begin + count);
  std::size_t const doubles = vortices_->doubles();
  auto const vorticity = static_cast<std::size_t>(vortices_->field("vorticity").offset);
  double const viscosity = vortices_->row(0)[vortices_->field("viscosity").offset];
  double const out = 4.0 / 3 * std::sqrt(viscosity * interval_ / pi);
  Field const* const volume = vortices_->find_field("volume");
  std::size_t at = begin;
  for (std::size_t b = 0; b < bodies_->bodies().size(); ++b) {
    AnyEnsemble& body = *bodies_->bodies()[b];
    if (std::find(which_.begin(), which_.end(), b) != which_.end()) {
      int const strength = body.field("sheet").offset, flux = body.field("flux").offset;
      for (std::size_t i = 0; i < body.size(); ++i, ++at) {
        auto const& panel = sheet.panels()[first_panel + i];
        double* const row = vortices_->row(at);
        std::copy_n(vortices_->row(0), doubles, row);
        auto const place = panel.middle() + panel.normal() * out;
        row[0] = place[0], row[1] = place[1];
        row[vorticity] = body.row(i)[strength] * panel.length;
        if (volume) row[volume->offset] = 0;
        body.row(i)[flux] = body.row(i)[strength] / interval_;
        shed_ += std::abs(row[vorticity]);
      }
    }
    first_panel += body.size();
  }
}

std::string NoSlip::report(UnitSystem const& units) const {
  return fmt::format("walls have made vorticity of both signs, {} in all", units.text(shed_, dimensions::circulation));
}

void NoSlip::restore(std::span<double const> state) {
  if (state.size() != 1) throw Error("the checkpoint does not fit this simulation: its bodies make no vorticity");
  shed_ = state[0];
}

}  // namespace boltzmann
