// PanelSheet: the vortex sheet on the panels of bodies that makes each outline a streamline of any flow.
// The strength is linear along each panel and continuous at corners (except a trailing edge). The stream function of
// the sheet plus the external flow is one constant at all corners of a body (M. Drela, XFOIL, in Low Reynolds Number
// Aerodynamics, Springer 1989). So the flux through each panel vanishes, the fluid inside is at rest, and outside it
// slips along the panel with the strength of the sheet as its speed. Corners and fluxes are staggered, which makes the
// equations well-conditioned. One further equation per body prescribes the total strength of its sheet, or a smooth
// flow at a trailing edge (Kutta).
#pragma once

#include <boltzmann/schemes/panels/linear_equations.hpp>
#include <boltzmann/schemes/panels/outline.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace boltzmann {

struct SheetPanel {
  Vector<2> from, along;  ///< the first corner, and a unit vector to the next one, counterclockwise
  double length;
  std::size_t first, second;  ///< indices of the strengths at its ends
  std::size_t body;

  Vector<2> middle() const { return from + along * (length / 2); }
  Vector<2> normal() const { return {along[1], -along[0]}; }  ///< outwards
};

/// The nearest panel to a place, the signed distance of the place from it (negative inside), and the nearest point of
/// the outline.
struct NearestPanel {
  std::size_t panel;
  double distance;
  Vector<2> foot;
};

class PanelSheet {
 public:
  /// Adds a body with this `circulation` of its sheet; with `kutta` it follows from the flow. Throws Error if the
  /// outline is invalid, has no trailing edge for a Kutta condition, or there would be more than 2000 panels.
  void add(Outline const& outline, double circulation, bool kutta);

  std::vector<SheetPanel> const& panels() const { return panels_; }
  std::size_t bodies() const { return bodies_.size(); }
  double circulation(std::size_t body) const;
  /// Prescribes the circulation of a body without a Kutta condition.
  void circulation(std::size_t body, double circulation) { bodies_[body].circulation = circulation; }
  /// At the ends of panels.
  std::vector<double> const& strengths() const { return strengths_; }
  void strengths(std::span<double const> strengths);

  /// Computes the strengths for a flow with this mean normal velocity on each panel. The first call factorises the
  /// equations. Throws Error if they are singular.
  void solve(std::span<double const> normal_velocity);

  /// The impulse, sum of strength times (y, -x), that a flow of these velocities adds to the sheet. Like `solve`, but
  /// without the sheet's own circulation. Zero before the first call of `solve`.
  Vector<2> added_impulse(std::span<double const> normal_velocity) const;

  /// The velocity of the sheet at any place, by the integrals over all panels.
  Vector<2> velocity(Vector<2> const& place) const;
  double stream_function(Vector<2> const& place) const;
  /// Adds the same to u and v at many places. The arrays extend places_padding numbers beyond their end.
  void add_velocities(double const* x, double const* y, double* u, double* v, std::size_t count, int threads) const;

  bool inside(Vector<2> const& place) const;
  /// True inside, at least this far from the outline.
  bool deep_inside(Vector<2> const& place, double depth) const {
    return inside(place) && nearest(place).distance < -depth;
  }
  /// The nearest of all panels; none if there are no bodies.
  NearestPanel nearest(Vector<2> const& place) const;
  std::size_t bytes() const;

 private:
  struct Body {
    std::size_t first_panel, panels, first_strength, strengths;
    double circulation;
    bool kutta;
    Vector<2> low, high;
  };
  /// Panels near the places of a cell, which are integrated instead of represented by points.
  struct NearCells {
    Vector<2> low{0, 0};
    double size = 1;
    std::size_t nx = 0, ny = 0;
    std::vector<std::uint32_t> begin, panels;
  };

  void factorise();
  /// Sets the right-hand side of the equations for the flow and, on request, the prescribed circulations.
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
