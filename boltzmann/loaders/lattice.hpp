// Lattices: particles on the sites of a block of crystal (BlockLoad of the 1990 thesis, section 6.3).
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/core/words.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace boltzmann {

/// A kind of lattice. In every kind `spacing` is the distance of nearest neighbours, as in the 1990 listings.
enum class Lattice {
  square,      ///< a line in 1D, square in 2D, simple cubic in 3D: 2, 4, 6 neighbours
  triangular,  ///< 2D: 6 neighbours; every second row is shifted by half a spacing
  fcc,         ///< 3D, face-centred cubic: 12 neighbours; the cube's edge is sqrt(2) spacing, 4 sites in it
  bcc,         ///< 3D, body-centred cubic: 8 neighbours; the cube's edge is 2/sqrt(3) spacing, 2 sites in it
  hcp,      ///< 3D, hexagonal close packing: 12 neighbours; triangular layers stacked along z, in cells of 1 x sqrt(3)
            ///< x sqrt(8/3) spacings, 4 sites in each
  diamond,  ///< 3D, two interpenetrating fcc lattices: 4 neighbours; the cube's edge is 4/sqrt(3) spacing, 8 sites in
            ///< it
};

Words<Lattice> const& lattice_words();
std::string to_string(Lattice kind);

/// A block of crystal: `counts` cells along x, y, z (numbers beyond the dimension are ignored). A cell is one site, or
/// the cube of fcc, bcc and diamond, or the block of hcp.
struct LatticeBlock {
  Lattice kind = Lattice::square;
  double spacing = 1;
  std::array<std::size_t, 3> counts{1, 1, 1};
  std::array<double, 3> origin{0, 0, 0};  ///< position of site 0
};

/// Number of sites of the block in a space of that dimension. Error if the lattice does not exist in it, or spacing or
/// origin are invalid.
std::size_t site_count(LatticeBlock const& block, int dimension);
/// The position of every site: cells in the order x fastest, then y, then z; inside a cell of several sites the corner
/// first.
std::vector<std::array<double, 3>> lattice_sites(LatticeBlock const& block, int dimension);
/// The periods of the block: it fills a periodic box of these lengths without a seam (for triangular only if the number
/// of rows is even).
std::array<double, 3> repeat_lengths(LatticeBlock const& block, int dimension);
/// The same block, shifted so that the outermost sites are equally far from the walls on both sides.
LatticeBlock centred(LatticeBlock block, Box const& box);
/// The distance of nearest neighbours at which the lattice has this number of sites per length, area or volume.
double spacing_for_density(Lattice kind, int dimension, double number_density);
/// The distance of nearest neighbours for a lattice constant: for fcc, bcc and diamond the edge of the cube.
double spacing_for_constant(Lattice kind, int dimension, double lattice_constant);

/// A lattice that fills the block from `low` to `high` exactly. Along each axis it has the number of cells that comes
/// nearest to this spacing, stretched to fit, with a site in the middle of each. For cells with several sites the
/// outermost are equally far from both ends. A triangular lattice has an even number of rows, so that it also fills a
/// periodic box. For particles that carry mass: each has an equal part of the volume.
struct Filling {
  Lattice kind = Lattice::square;
  double spacing = 1;
  std::array<double, 3> low{0, 0, 0}, high{1, 1, 1};
  double density = 0;  ///< fill_load: mass per length, area or volume; 0: masses are kept
  double range = 0;    ///< fill_load: of each smooth particle; 0: ranges are kept
};
/// Error if the lattice can't fill it, the spacing is not positive or low is not below high.
std::size_t filling_count(Filling const& filling, int dimension);
/// In the order x fastest, then y, then z.
std::vector<std::array<double, 3>> filling_sites(Filling const& filling, int dimension);
/// The length, area or volume per site.
double site_volume(Filling const& filling, int dimension);

/// The spacing for which a filling has this number of sites, with cells as regular as possible. Error with the nearest
/// possible numbers, if there is none.
double spacing_for_number(Filling filling, int dimension, std::size_t number);

/// Puts particle k on site k. An ensemble without particles gets one for each site, and is drawn with the spacing as
/// diameter unless one is set. Returns the number of placed particles: all of the ensemble. Error if the numbers of
/// existing particles and sites differ.
///   block_load(atoms, {Lattice::triangular, r0, {25, 10}})
std::size_t block_load(AnyEnsemble& ensemble, LatticeBlock const& block);
/// The same on the sites of a filling; each particle gets its part of the mass if a density is given, and the given
/// range. Error for an invalid density or range.
std::size_t fill_load(AnyEnsemble& ensemble, Filling const& filling);
/// The filling of a whole box: fill_load(gas, box, {.spacing = 0.05, .density = 1, .range = 0.15}).
std::size_t fill_load(AnyEnsemble& ensemble, Box const& box, Filling filling);

}  // namespace boltzmann
