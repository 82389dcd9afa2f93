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
    all.at("on").doc = "ensembles that make and feel the field; any mass makes gravity, vorticity a flow";
    all.at("on").otherwise =
        "`Coulomb` for `\"coulomb\"`, `Kepler` for `\"gravity\"`, vortex classes for `\"biot-savart\"` and its kind";
    all.add_said("softening", number(dimensions::length, not_negative), "Plummer's softening length", "0");
    all.add_said("transposed", number(dimensions::none, {0, 1}),
                 "vortices in 3D: part of the stretching in transposed form, which conserves total vorticity", "1");
    all.add("tolerance", &MultipoleOptions::tolerance, number(dimensions::none, NumberRange{1e-10, 0.1}),
            "measured and kept error of all forces or velocities, relative to their rms");
    all.add_said("test_particles", ensembles(), "test particles: ensembles that feel the field without making it",
                 "none");
    all.add("background", &MultipoleOptions::background, flag(),
            "a uniform background neutralises a box that is periodic along all axes");
    all.add(
        "every", &MultipoleOptions::every, whole(1, 1e6),
        "steps between evaluations, which are weighted accordingly (r-RESPA); energies are right at multiples of it");
    all.add("grid", &MultipoleOptions::grid, wholes_by_axis(1, 1e9),
            "cells of a grid for potential and field (or velocity) in pictures and files", "none");
    return all;
  }();
  return all;
}

}  // namespace boltzmann
