// PanelSheet: the vortex sheet on the panels of bodies that makes each outline a streamline of any flow.
//
// The strength is linear along each panel and continuous at corners (but for a trailing edge). The stream function of the
// sheet and of what comes from outside is one constant at all corners of a body (M. Drela, XFOIL, in Low Reynolds Number
// Aerodynamics, Springer 1989): the flux through each panel vanishes, inside is no flow, and outside the fluid slips
// along the panel as fast as the sheet is strong. Corners and fluxes are staggered, which makes the equations
// well-conditioned. One more equation a body says how strong its sheet is in all, or that the flow leaves a trailing edge
// smoothly (Kutta).
#pragma once

#include <boltzmann/schemes/panels/linear_equations.hpp>
#include <boltzmann/schemes/panels/outline.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace boltzmann {

struct SheetPanel {
  Vector<2> from, along;  ///< the corner that it begins at, and a unit vector to the next one, counterclockwise
  double length;
  std::size_t first, second;  ///< of strengths, at its ends
  std::size_t body;

  Vector<2> middle() const { return from + along * (length / 2); }
  Vector<2> normal() const { return {along[1], -along[0]}; }  ///< out of the body
};

/// The nearest panel to a place, how far the place lies out of the body along its normal direction (below zero: inside),
/// and the nearest point of the outline.
struct NearestPanel {
  std::size_t panel;
  double distance;
  Vector<2> foot;
};

class PanelSheet {
 public:
  /// A further body. `circulation` of its sheet; with `kutta` it follows from the flow. Error if the outline is wrong, has
  /// no trailing edge for a Kutta condition, or there would be more than 2000 panels.
  void add(Outline const& outline, double circulation, bool kutta);

  std::vector<SheetPanel> const& panels() const { return panels_; }
  std::size_t bodies() const { return bodies_.size(); }
  double circulation(std::size_t body) const;
  /// Prescribes it, of a body without a Kutta condition.
  void circulation(std::size_t body, double circulation) { bodies_[body].circulation = circulation; }
  /// At the ends of panels.
  std::vector<double> const& strengths() const { return strengths_; }
  void strengths(std::span<double const> strengths);

  /// Finds the strengths for a flow whose velocity along the normal of each panel, in the mean, is this. The first call
  /// factorises the equations. Error if they are singular.
  void solve(std::span<double const> normal_velocity);

  /// The impulse, sum of strength times (y, -x), that a flow of these velocities adds to the sheet: as `solve`, but what the
  /// sheet has without it is left out. Nothing before the first call of `solve`.
  Vector<2> added_impulse(std::span<double const> normal_velocity) const;

  /// Of the sheet, at any place, by the integrals over all panels.
  Vector<2> velocity(Vector<2> const& place) const;
  double stream_function(Vector<2> const& place) const;
  /// Adds the same to u and v at many places, of arrays with places_padding numbers behind their last.
  void add_velocities(double const* x, double const* y, double* u, double* v, std::size_t count, int threads) const;

  bool inside(Vector<2> const& place) const;
  /// Inside, and at least so far from the outline.
  bool deep_inside(Vector<2> const& place, double depth) const {
    return inside(place) && nearest(place).distance < -depth;
  }
  /// Of all panels; none if there are no bodies.
  NearestPanel nearest(Vector<2> const& place) const;
  std::size_t bytes() const;

 private:
  struct Body {
    std::size_t first_panel, panels, first_strength, strengths;
    double circulation;
    bool kutta;
    Vector<2> low, high;
  };
  /// Panels that are near places of a cell, for which points do not stand.
  struct NearCells {
    Vector<2> low{0, 0};
    double size = 1;
    std::size_t nx = 0, ny = 0;
    std::vector<std::uint32_t> begin, panels;
  };

  void factorise();
  /// The right-hand side of the equations, of the flow and, if told, of what circulations are prescribed.
  void state_equations(std::span<double const> normal_velocity, bool prescribed, std::vector<double>& numbers) const;
  void find_near_cells();
  void place_points();
  Vector<2> velocity(SheetPanel const& panel, Vector<2> const& place) const;
  Vector<2> velocity_of_points(std::size_t panel, Vector<2> const& place) const;

  std::vector<Body> bodies_;
  std::vector<SheetPanel> panels_;
  std::vector<double> strengths_;
  LinearEquations equations_;
  std::vector<double> numbers_;  // right-hand side, then solution
  double smooth2_ = 0, core2_ = 0;
  NearCells near_;
  std::vector<double> point_x_, point_y_, point_strength_;
};

}  // namespace boltzmann
