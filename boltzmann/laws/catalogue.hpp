// The catalogue of laws: what scenario files, `bzm show` and the reference pages know about each law.
#pragma once

#include <boltzmann/core/dimension.hpp>
#include <boltzmann/laws/interaction.hpp>
#include <boltzmann/laws/parameter.hpp>

#include <string_view>
#include <vector>

namespace boltzmann {

enum class LawKind {
  pair,      ///< between two particles: law(p, q)
  external,  ///< from outside: law(p)
};

/// One parameter of a law: a member of its struct, or the argument of its factory.
struct LawParameter {
  std::string_view name;
  Dimension dimension;  ///< the same in 1D, 2D and 3D: in fewer dimensions particles are sheets and rods of unit size
  std::string_view doc;
  AllowedRange range;
  bool vector = false;                 ///< one number for each dimension of the space
  std::string_view default_text = {};  ///< as a scenario would write it; empty: required
  bool in_reduced_base = true;         ///< false: the default has units, so a base without units needs the value
  bool axial = false;                  ///< of a vector: that of a rotation, which in 2D is one number, out of the plane
};

struct LawInfo {
  std::string_view name;  ///< the word in scenarios: "lennard-jones"
  LawKind kind;
  std::string_view doc;      ///< one line
  std::string_view formula;  ///< energy, or influence where there is no energy
  std::string_view target;   ///< the least class of the particle that is influenced
  std::string_view source;   ///< the least class of the particle that influences; empty for external laws
  int least_dimension, greatest_dimension;
  Symmetry symmetry;  ///< of pair laws; one_way can always be asked for
  bool has_energy;
  bool velocity_dependent;
  std::string_view header;  ///< for programs
  std::string_view type;    ///< what a program writes: "LennardJones", "gravity"
  std::vector<LawParameter> parameters;
};

/// Every law that is shipped, pair laws first.
std::vector<LawInfo> const& law_catalogue();

/// The entry of that name; Error with the nearest name if there is none.
LawInfo const& law_info(std::string_view name);

}  // namespace boltzmann
