// Mirrors particles at the outline.
#include <boltzmann/core/error.hpp>
#include <boltzmann/simulation/outside_bodies.hpp>

#include <fmt/format.h>

namespace boltzmann {

void OutsideBodies::change() {
  auto const& sheet = bodies_->sheet();
  for (auto* ensemble : bodies_->carried()) {
    Field const* const volume = ensemble->find_field("volume");
    for (std::size_t i = 0; i < ensemble->size(); ++i) {
      double* const row = ensemble->row(i);
      Vector<2> const place{row[0], row[1]};
      if (!sheet.inside(place)) continue;
      auto const nearest = sheet.nearest(place);
      auto const& panel = sheet.panels()[nearest.panel];
      auto back = nearest.foot + (nearest.foot - place);
      if (sheet.inside(back) || back == place) back = nearest.foot + panel.normal() * (1e-6 * panel.length);
      row[0] = back[0], row[1] = back[1];
      if (volume) row[volume->offset] = 0;
      ++put_back_;
    }
  }
}

std::string OutsideBodies::report(UnitSystem const&) const {
  return put_back_ == 0 ? "" : fmt::format("{} times a particle was put back that had got into a body", put_back_);
}

void OutsideBodies::restore(std::span<double const> state) {
  if (state.size() != 1) throw Error("the checkpoint does not fit this simulation: it has no bodies");
  put_back_ = static_cast<std::size_t>(state[0]);
}

void check_outside(PanelScheme const& bodies) {
  for (auto const* ensemble : bodies.carried())
    for (std::size_t i = 0; i < ensemble->size(); ++i)
      if (bodies.sheet().inside({ensemble->row(i)[0], ensemble->row(i)[1]}))
        throw Error(fmt::format("particle {} of '{}' is inside a body", i, ensemble->name()));
}

}  // namespace boltzmann
