// The keys of multipole schemes.
#include <boltzmann/schemes/field_options.hpp>
#include <boltzmann/schemes/multipole/multipole_options.hpp>

namespace boltzmann {

OptionTable const& multipole_options() {
  static OptionTable const all = [] {
    using namespace option;
    OptionTable all;
    add_field_keys(all);
    all.at("law").kind.words = {
        "coulomb with `k`, gravity with `G`, biot-savart, biot-savart-algebraic or biot-savart-gaussian"};
    all.at("on").doc =
        "who makes the field and feels it; gravity is made by the mass of any class, a flow by vorticity";
    all.at("on").otherwise =
        "`Coulomb` for `\"coulomb\"`, `Kepler` for `\"gravity\"`, `Vortex`, `Inviscid`, `Viscous`, `Diffusive` for "
        "`\"biot-savart\"` and its kind";
    all.add_said("softening", number(dimensions::length, not_negative),
                 "Plummer's length, within which the force is weaker", "0");
    all.add_said(
        "transposed", number(dimensions::none, {0, 1}),
        "how much the stretching of vorticity in 3D is of the transposed form, which keeps its sum; of vortices", "1");
    all.add("tolerance", &MultipoleOptions::tolerance, number(dimensions::none, NumberRange{1e-10, 0.1}),
            "error of all forces or velocities, as a part of their rms; it is measured, and kept");
    all.add_said("test_particles", ensembles(), "who feels the field without making it", "none");
    all.add("background", &MultipoleOptions::background, flag(),
            "a uniform background makes a box that is periodic along all axes neutral");
    all.add(
        "every", &MultipoleOptions::every, whole(1, 1e6),
        "so many steps from one calculation to the next, which then counts as often (r-RESPA); energies are right at "
        "multiples of it");
    all.add("grid", &MultipoleOptions::grid, wholes_by_axis(1, 1e9),
            "cells of a grid with the potential and the field (or velocity) on its nodes, for pictures and files",
            "none");
    return all;
  }();
  return all;
}

}  // namespace boltzmann
