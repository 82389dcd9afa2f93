// PanelScheme: solid bodies in a plane flow, each an outline of panels with a vortex sheet that makes it a streamline.
//   Ensemble<Panel<2>> cylinder("cylinder");
//   PanelScheme bodies(box);
//   bodies.add_body(cylinder, circle_outline({0, 0}, 1, 200));
//   bodies.add(tracers);                                        // particles advected by the sheet
//   pairs.external(cylinder, UniformFlow<2>{{1, 0}});           // all flows must act on the body, too
//   Simulation simulation(pairs, dt);
//   simulation.add(bodies);
#pragma once

#include <boltzmann/particles/panel.hpp>
#include <boltzmann/schemes/after_others.hpp>
#include <boltzmann/schemes/panels/panel_sheet.hpp>
#include <boltzmann/schemes/scheme.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace boltzmann {

struct BodySheet {
  double circulation = 0;  ///< of the body's vortex sheet; constant by Kelvin's theorem
  bool kutta = false;      ///< instead, the circulation for which the flow leaves the trailing edge smoothly
};

class PanelScheme final : public Scheme, public AfterOthers {
 public:
  /// Throws Error if the box is not two-dimensional, or has axes other than open and reflecting ones: the sheet has no
  /// images.
  explicit PanelScheme(Box box);

  /// Adds a body at rest: fills the ensemble with its panels. The sheet is computed from the velocities of all other
  /// schemes on these, so let vortices and streams act on the body as on tracers. Throws Error as PanelSheet::add()
  /// does.
  void add_body(Ensemble<Panel<2>>& body, Outline const& outline, BodySheet const& sheet = {});
  /// Adds tracers or vortices that the sheet advects. Throws Error if a flow does not advect them.
  void add(AnyEnsemble& ensemble);

  std::vector<AnyEnsemble*> const& bodies() const { return bodies_; }
  std::vector<AnyEnsemble*> const& carried() const { return carried_; }
  /// The result of the last calculation.
  PanelSheet const& sheet() const { return sheet_; }
  PanelSheet& sheet() { return sheet_; }

  void add_influences(double time) override;
  /// Uses the sheet of the last calculation.
  void add_stream(std::span<double const> places, double time, std::span<double> velocities) override;
  EnergyAndVirial measure(double time = 0) override;
  double length_scale(AnyEnsemble const&) const override { return __builtin_inf(); }
  std::string explain(AnyEnsemble const&, std::size_t) const override { return ""; }
  void make_reversible(double quantum) override;
  std::string undivided() const override { return ""; }
  /// Every rank computes the sheet, and advects its own particles.
  void divide(Division* division) override { division_ = division; }
  std::size_t bytes() const override;
  std::string summary() const override;
  std::vector<double> state() const override { return sheet_.strengths(); }
  void restore(std::span<double const> state) override { sheet_.strengths(state); }

 private:
  void find_sheet();
  void carry(AnyEnsemble& ensemble);

  PanelSheet sheet_;
  Division* division_ = nullptr;  // set during a divided run
  std::vector<AnyEnsemble*> bodies_, carried_;
  std::vector<double> normal_velocity_, x_, y_, u_, v_;
};

}  // namespace boltzmann
