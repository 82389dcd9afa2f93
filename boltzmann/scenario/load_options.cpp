// The options of loaders with their keys, and the options of each kind.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/once.hpp>
#include <boltzmann/loaders/particle_file.hpp>
#include <boltzmann/scenario/load_options.hpp>

#include <limits>

namespace boltzmann {
namespace {

using namespace option;

constexpr double unlimited = std::numeric_limits<double>::infinity();

OptionTable make_members() {  // long: a table, a row for each key
  using L = LoadOptions;
  OptionTable all;
  all.add("lattice", &L::lattice, lattice_words(), "`\"square\"`: in 1D a line, in 3D simple cubic");
  all.add("spacing", &L::spacing, number(dimensions::length, positive), "of nearest neighbours",
          "`number_density` says it");
  all.add("number_density", &L::number_density, number_by_space(dimensions::none, -1, positive),
          "instead of the spacing: particles per length, area or volume", "`spacing` says it");
  all.add("lattice_constant", &L::lattice_constant, number(dimensions::length, positive),
          "instead of the spacing: of fcc, bcc and diamond the edge of their cube", "`spacing` says it");
  all.add_said("counts", "a list of whole numbers, one for each axis", "cells along each axis");
  all.add_said("origin", "a length along each axis, or `\"centred\"`", "of the first site", "centred in the box");
  all.add("jitter", &L::jitter, number(dimensions::none, {0, 1}),
          "moved at random, by at most this part of the spacing along each axis");
  all.add("low", &L::low, vector(dimensions::length), "where the lattice begins", "the box");
  all.add("high", &L::high, vector(dimensions::length), "where it ends", "the box");
  all.add_said("where", text("a [formula](#formulas)"), "only where it is true: `\"r < 1\"`", "everywhere");
  all.add("minimum_distance", &L::minimum_distance, number(dimensions::length, not_negative), "between any two");
  all.add(
      "packing_fraction", &L::packing_fraction, number(dimensions::none, {0, 0.7476, true}),
      "of the block, filled by rods, discs or spheres that don't overlap, added at random: below 0.7476 in 1D, 0.547 "
      "in 2D, 0.384 in 3D. `number` says how wide they are, or `minimum_distance` how many",
      "none");
  all.add("axis", &L::axis, axis_word(), "of the wave");
  all.add("mode", &L::mode, whole(1, unlimited), "periods in the box", "or `wave_number`");
  all.add("wave_number", &L::wave_number, number(dimensions::wave_number, positive), "2 pi over the wave's length",
          "or `mode`");
  all.add("phase", &L::phase, number(dimensions::angle), "the density is 1 + amplitude sin(k x + phase)");
  all.add("amplitude", &L::amplitude, number(dimensions::none, {-1, 1}), "of the density");
  all.add("component", &L::component, axis_word(), "of the velocity", "that along the wave");
  all.add("quiet", &L::quiet, flag(), "at the quantiles, without noise; else at random");
  all.add("temperature", &L::temperature, number(dimensions::temperature, positive), "of the atmosphere");
  all.add("acceleration", &L::acceleration, number(dimensions::acceleration), "downwards, along the last axis");
  all.add_said("positions", "a list of places, `[[0, 0], [1, 0]]`", "one for each particle");
  all.add("path", &L::path, path(), "from the scenario's folder");
  all.add("format", &L::format, word(particle_file_names()), "of the file", "by its ending, else by its content");
  all.add("frame", &L::frame, whole(0, unlimited), "of the file, from 0");
  all.add("ensemble", &L::ensemble, text(), "of the stored run", "the one of this name");
  all.add("species", &L::species, text(), "only these: an element, a name, the number of a type", "all");
  all.add("units", &L::units, word(particle_file_units()),
          "the file's units, by LAMMPS' words; `\"ase\"`: those of ASE, so that momenta become velocities",
          "what the file says, else the base's");
  all.add("style", &L::style, word(particle_file_styles()), "the atom style of LAMMPS data", "what the file says");
  all.add("length", &L::length, number(dimensions::length, positive), "the file's unit of length",
          "what the file says, else the base's");
  all.add("velocity", &L::velocity, number(dimensions::velocity, positive), "and of velocities",
          "what the file says, else the base's");
  all.add("mass", &L::mass, number(dimensions::mass, positive), "of all together");
  all.add("radius", &L::radius, number(dimensions::length, positive),
          "Plummer's: half of the mass is within 1.305 of it");
  all.add("G", &L::G, number(dimensions::volume / (dimensions::mass * pow(dimensions::time, 2)), positive),
          "Newton's constant, by which they move", "that of nature; 1 of pure numbers");
  all.add("centre", &L::centre, vector(dimensions::length), "of the cluster", "0 on each axis");
  all.add("drift", &L::drift, vector(dimensions::velocity), "how the cluster moves", "0 on each axis");
  all.add("profile", &L::profile, disc_profile_words(),
          "`\"exponential\"`: the surface density falls as exp(-R / radius); `\"kuzmin\"`: as (R^2 + radius^2)^(-3/2); "
          "`\"uniform\"`");
  all.add("edge", &L::edge, number(dimensions::length, positive), "where the disc ends",
          "5 radii; of a uniform one its radius");
  all.add("central_mass", &L::central_mass, number(dimensions::mass, not_negative),
          "of another ensemble in the middle, about which they move, too");
  all.add("normal", &L::normal, vector(dimensions::none), "in 3D, of any length: the ring goes around it",
          "the z axis");
  all.add("ripple", &L::ripple, number(dimensions::none, {-1, 1}), "its radius is radius (1 + ripple cos(mode angle))");
  all.add("circulation", &L::circulation, number(dimensions::circulation), "around the tube");
  all.add("core_radius", &L::core_radius, number(dimensions::length, positive),
          "where the vorticity of the tube is 1/e of that in its middle");
  all.add("layers", &L::layers, whole(0, 50), "of elements around the one in the middle of a section");
  all.add("overlap", &L::overlap, number(dimensions::none, positive), "the core of an element over the spacing");
  all.add("sections", &L::sections, whole(1, 1e6), "around the ring", "as dense as elements are in a section");
  all.at("core_radius").needed = "0.1";
  all.at("mass").needed = "\"1e4 Msun\"";
  all.at("radius").needed = "\"1 pc\"";
  all.at("counts").needed = "[25, 10]";
  all.at("amplitude").needed = "0.1";
  all.at("temperature").needed = "\"300 K\"";
  all.at("acceleration").needed = "\"9.81 m/s^2\"";
  all.at("positions").needed = "[[0, 0], [1, 0]]";
  all.at("path").needed = "\"atoms.xyz\"";
  return all;
}

std::vector<LoadKind> make_kinds() {  // long: a table, an entry for each kind
  OptionTable const members = make_members();
  auto const of = [&](std::vector<OptionKey> const& keys) { return members.only(keys); };
  OptionKey const about{"spacing", "about that of nearest neighbours: cells fill the block exactly",
                        "`number_density` or the ensemble's `number` says it"};
  OptionKey const about_density{"number_density", "instead of the spacing: about so many per length, area or volume"};
  return {
      {"block", "a block of crystal", false,
       of({{"lattice"},
           {"spacing", "", "`lattice_constant` or `number_density` says it"},
           {"lattice_constant"},
           {"number_density"},
           {"counts"},
           {"origin"},
           {"jitter"}})},
      {"fill", "a lattice that fills a block exactly, a particle in the middle of each cell", false,
       of({{"lattice"}, about, about_density, {"low"}, {"high"}, {"where"}, {"jitter"}})},
      {"random", "uniform in the box, or in a part of it", true,
       of({{"low", "where their block begins"},
           {"high", "where it ends"},
           {"where"},
           {"minimum_distance"},
           {"packing_fraction"}})},
      {"quiet", "uniform without noise: in order along x, evenly in bit-reversed order along the others", true, {}},
      {"sinusoidal", "a density with a wave", true,
       of({{"axis"}, {"mode"}, {"wave_number"}, {"phase"}, {"amplitude"}, {"quiet"}})},
      {"barometric", "the barometric density along the last axis", true, of({{"temperature"}, {"acceleration"}})},
      {"plummer-sphere", "Plummer's cluster of stars, at rest in its own gravity, with masses and velocities", true,
       of({{"mass"}, {"radius"}, {"G"}, {"centre"}, {"drift"}})},
      {"disc", "a disc of masses, each on a circle in the gravity of all", true,
       of({{"profile"},
           {"mass", "of all together; 0: they feel the middle alone", "", "\"5e10 Msun\"",
            number(dimensions::mass, not_negative)},
           {"radius", "over which it falls; where a uniform one ends", "", "\"3 kpc\""},
           {"edge"},
           {"central_mass"},
           {"G"},
           {"centre", "of the disc"},
           {"drift", "how the disc moves"},
           {"normal", "in 3D, of any length: they go around it"}})},
      {"ring", "evenly on a circle", true,
       of({{"radius", "of the circle", "", "1"},
           {"centre", "of the circle"},
           {"normal"},
           {"mode", "periods of a ripple around the circle", "none"},
           {"ripple"}})},
      {"ring-tube", "a ring of vorticity with a resolved core in 3D, whose elements get their vorticity and cores",
       false,
       of({{"radius", "of the ring", "", "1"},
           {"core_radius"},
           {"circulation"},
           {"centre", "of the ring"},
           {"normal", "of any length: where the ring goes to"},
           {"layers"},
           {"sections"},
           {"overlap"}})},
      {"path",
       "a lattice that fills the box, in the order of a random path from neighbour to neighbour: chains of a melt",
       false, of({{"counts", "sites along each axis"}})},
      {"positions", "where you say", false, of({{"positions"}})},
      {"file",
       "a file of another program, also compressed by gzip: XYZ, LAMMPS data or dump, PDB, GRO, POSCAR; its lattice "
       "has "
       "to be the box along axes that are periodic in both",
       false, of({{"path"}, {"format"}, {"frame"}, {"species"}, {"units"}, {"style"}, {"length"}, {"velocity"}})},
      {"frame", "a frame of the trajectory of another run, with all fields that both have", false,
       of({{"path", "of a trajectory.h5, from the scenario's folder", "", "\"results/melt/trajectory.h5\""},
           {"ensemble"},
           {"frame", "from 0 on; negative: from the end", "the last one", "", whole(-1e9, 1e9)}})},
  };
}

}  // namespace

std::vector<LoadKind> const& load_kinds() { return once<make_kinds>(); }

OptionTable const& ripple_options() {
  static OptionTable const all =
      make_members().only({{"axis"},
                           {"mode"},
                           {"wave_number"},
                           {"phase", "the velocity is amplitude sin(k x + phase)"},
                           {"component"},
                           {"amplitude", "of the velocity", "", "0.1", number(dimensions::velocity)}});
  return all;
}

}  // namespace boltzmann
