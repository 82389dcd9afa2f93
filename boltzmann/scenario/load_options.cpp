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
  all.add("lattice", &L::lattice, lattice_words(), "lattice; `\"square\"` is a line in 1D, simple cubic in 3D");
  all.add("spacing", &L::spacing, number(dimensions::length, positive), "distance of nearest neighbours",
          "or `number_density`");
  all.add("number_density", &L::number_density, number_by_space(dimensions::none, -1, positive),
          "particles per length, area or volume, instead of `spacing`", "or `spacing`");
  all.add("lattice_constant", &L::lattice_constant, number(dimensions::length, positive),
          "edge of the cube of fcc, bcc and diamond, instead of `spacing`", "or `spacing`");
  all.add_said("counts", "a list of whole numbers, one for each axis", "cells along each axis");
  all.add_said("origin", "a length along each axis, or `\"centred\"`", "position of the first site", "centred");
  all.add("jitter", &L::jitter, number(dimensions::none, {0, 1}),
          "largest random displacement along each axis, in spacings");
  all.add("low", &L::low, vector(dimensions::length), "lower edges of the lattice", "the box");
  all.add("high", &L::high, vector(dimensions::length), "upper edges", "the box");
  all.add_said("where", text("a [formula](../formulas.md)"), "place particles only where it is true: `\"r < 1\"`",
               "everywhere");
  all.add("minimum_distance", &L::minimum_distance, number(dimensions::length, not_negative),
          "smallest distance of two particles");
  all.add("packing_fraction", &L::packing_fraction, number(dimensions::none, {0, 0.7476, true}),
          "volume fraction of rods, discs or spheres without overlap, added at random: below 0.7476 in 1D, 0.547 in "
          "2D, 0.384 in 3D. With `number` it sets their diameter, with `minimum_distance` their number",
          "none");
  all.add("axis", &L::axis, axis_word(), "axis of the wave");
  all.add("mode", &L::mode, whole(1, unlimited), "periods in the box", "or `wave_number`");
  all.add("wave_number", &L::wave_number, number(dimensions::wave_number, positive), "2 pi over the wavelength",
          "or `mode`");
  all.add("phase", &L::phase, number(dimensions::angle), "the density is 1 + amplitude sin(k x + phase)");
  all.add("amplitude", &L::amplitude, number(dimensions::none, {-1, 1}), "amplitude of the density");
  all.add("component", &L::component, axis_word(), "component of the velocity", "that of `axis`");
  all.add("quiet", &L::quiet, flag(), "place at the quantiles, without noise; else at random");
  all.add("temperature", &L::temperature, number(dimensions::temperature, positive), "temperature of the atmosphere");
  all.add("acceleration", &L::acceleration, number(dimensions::acceleration), "gravity, downwards along the last axis");
  all.add_said("positions", "a list of positions, `[[0, 0], [1, 0]]`", "position of each particle");
  all.add("path", &L::path, path(), "path, relative to the scenario");
  all.add("format", &L::format, word(particle_file_names()), "format of the file",
          "by its extension, else its content");
  all.add("frame", &L::frame, whole(0, unlimited), "frame of the file, from 0");
  all.add("ensemble", &L::ensemble, text(), "ensemble of the stored run", "that of this name");
  all.add("species", &L::species, text(), "read only this type: an element, a name or a number", "all");
  all.add("units", &L::units, word(particle_file_units()),
          "units of the file, a style of LAMMPS; `\"ase\"`: those of ASE, whose momenta become velocities",
          "as in the file, else base units");
  all.add("style", &L::style, word(particle_file_styles()), "atom style of LAMMPS data", "as in the file");
  all.add("length", &L::length, number(dimensions::length, positive), "unit of length in the file",
          "as in the file, else the base unit");
  all.add("velocity", &L::velocity, number(dimensions::velocity, positive), "unit of velocity in the file",
          "as in the file, else the base unit");
  all.add("mass", &L::mass, number(dimensions::mass, positive), "total mass");
  all.add("radius", &L::radius, number(dimensions::length, positive),
          "Plummer radius; half of the mass is within 1.305 of it");
  all.add("G", &L::G, number(dimensions::volume / (dimensions::mass * pow(dimensions::time, 2)), positive),
          "Newton's constant", "that of nature; 1 in reduced units");
  all.add("centre", &L::centre, vector(dimensions::length), "centre of the cluster", "0 on each axis");
  all.add("drift", &L::drift, vector(dimensions::velocity), "velocity of the cluster", "0 on each axis");
  all.add("profile", &L::profile, disc_profile_words(),
          "surface density: `\"exponential\"`: exp(-R / radius); `\"kuzmin\"`: (R^2 + radius^2)^(-3/2); `\"uniform\"`");
  all.add("edge", &L::edge, number(dimensions::length, positive), "outer radius", "5 radii; `radius` if uniform");
  all.add("central_mass", &L::central_mass, number(dimensions::mass, not_negative),
          "mass of another ensemble at the centre, which also attracts");
  all.add("normal", &L::normal, vector(dimensions::none), "3D: axis of the ring, of any length", "the z axis");
  all.add("ripple", &L::ripple, number(dimensions::none, {-1, 1}), "the radius is radius (1 + ripple cos(mode angle))");
  all.add("circulation", &L::circulation, number(dimensions::circulation), "circulation around the tube");
  all.add("core_radius", &L::core_radius, number(dimensions::length, positive),
          "radius where the vorticity of the tube is 1/e of its maximum");
  all.add("layers", &L::layers, whole(0, 50), "rings of elements around the middle of a section");
  all.add("overlap", &L::overlap, number(dimensions::none, positive), "core of an element over the spacing");
  all.add("sections", &L::sections, whole(1, 1e6), "elements around the ring", "at the spacing of the section");
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
  OptionKey const about{"spacing", "approximate distance of neighbours; cells fill the block exactly",
                        "or `number_density`, or the ensemble's `number`"};
  OptionKey const about_density{"number_density",
                                "approximate particles per length, area or volume, instead of `spacing`"};
  return {
      {"block", "a block of crystal", false,
       of({{"lattice"},
           {"spacing", "", "or `lattice_constant` or `number_density`"},
           {"lattice_constant"},
           {"number_density"},
           {"counts"},
           {"origin"},
           {"jitter"}})},
      {"fill", "a lattice that fills a block exactly, with a particle in the middle of each cell", false,
       of({{"lattice"}, about, about_density, {"low"}, {"high"}, {"where"}, {"jitter"}})},
      {"random", "uniform at random in the box or a block", true,
       of({{"low", "lower edges of the block"},
           {"high", "upper edges"},
           {"where"},
           {"minimum_distance"},
           {"packing_fraction"}})},
      {"quiet", "uniform without noise: ordered along x, bit-reversed along other axes", true, {}},
      {"sinusoidal", "a density wave", true,
       of({{"axis"}, {"mode"}, {"wave_number"}, {"phase"}, {"amplitude"}, {"quiet"}})},
      {"barometric", "the barometric density along the last axis", true, of({{"temperature"}, {"acceleration"}})},
      {"plummer-sphere", "Plummer's star cluster in equilibrium with its own gravity, with masses and velocities", true,
       of({{"mass"}, {"radius"}, {"G"}, {"centre"}, {"drift"}})},
      {"disc", "a disc of masses on circular orbits in their common gravity", true,
       of({{"profile"},
           {"mass", "total mass; 0: test particles around the centre", "", "\"5e10 Msun\"",
            number(dimensions::mass, not_negative)},
           {"radius", "scale length; outer radius if uniform", "", "\"3 kpc\""},
           {"edge"},
           {"central_mass"},
           {"G"},
           {"centre", "centre of the disc"},
           {"drift", "velocity of the disc"},
           {"normal", "3D: axis of rotation, of any length"}})},
      {"ring", "equally spaced on a circle", true,
       of({{"radius", "centre of the circle", "", "1"},
           {"centre", "radius of the circle"},
           {"normal"},
           {"mode", "periods of a ripple around the circle", "none"},
           {"ripple"}})},
      {"ring-tube", "a vortex ring with a resolved core in 3D; sets vorticity and cores of the elements", false,
       of({{"radius", "centre of the ring", "", "1"},
           {"core_radius"},
           {"circulation"},
           {"centre", "radius of the ring"},
           {"normal", "direction in which the ring moves, of any length"},
           {"layers"},
           {"sections"},
           {"overlap"}})},
      {"path", "a lattice that fills the box, ordered along a random path of neighbours: chains of a melt", false,
       of({{"counts", "sites along each axis"}})},
      {"positions", "the positions that you list", false, of({{"positions"}})},
      {"file",
       "a file of another program, also compressed by gzip: XYZ, LAMMPS data or dump, PDB, GRO, POSCAR; its cell must "
       "equal the box along axes that are periodic in both",
       false, of({{"path"}, {"format"}, {"frame"}, {"species"}, {"units"}, {"style"}, {"length"}, {"velocity"}})},
      {"frame", "a frame of another run's trajectory, with all common fields", false,
       of({{"path", "path of a trajectory.h5, relative to the scenario", "", "\"results/melt/trajectory.h5\""},
           {"ensemble"},
           {"frame", "from 0; negative: from the end", "the last", "", whole(-1e9, 1e9)}})},
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
                           {"amplitude", "amplitude of the velocity", "", "0.1", number(dimensions::velocity)}});
  return all;
}

}  // namespace boltzmann
