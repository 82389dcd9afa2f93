// The keys of mesh schemes.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/once.hpp>
#include <boltzmann/schemes/field_options.hpp>
#include <boltzmann/schemes/mesh/mesh_options.hpp>

namespace boltzmann {
namespace {

using namespace option;

OptionTable make_mesh_options() {
  using M = MeshOptions;
  OptionTable all;
  add_field_keys(all);
  all.add("cells", &M::cells, wholes_by_axis(1, 1e9), "of the mesh", "needed, but with `accuracy`");
  all.add("assignment", &M::assignment, assignment_words(), "how particles are spread over nodes");
  all.add("poisson", &M::poisson, poisson_form_words(), "Poisson's equation on the mesh");
  all.add_said("boundary", join(field_boundary_words().names()) + "; a word, or for each axis a word or a pair",
               "of the field", "periodic where the box is, elsewhere open");
  all.add("background", &M::background, flag(), "a uniform background makes the whole neutral");
  all.add("precision", &M::precision, precision_words(), "of the particles during a run");
  all.add("accuracy", &M::accuracy, number(dimensions::none, positive),
          "P3M: mesh plus near pairs, forces to this part of their rms; `cells`, `assignment`, `poisson`, `boundary` "
          "and `precision` are then chosen for you",
          "a mesh alone");
  all.add("bonded_factors", &M::bonded_factors, numbers(dimensions::none),
          "with `accuracy`: of charges 1, 2, 3, ... bonds apart (`bonds` of `[[ensembles]]`), `[0, 0, 0.5]`; 0: they "
          "don't act on each other",
          "1: as all others");
  return all;
}

}  // namespace

OptionTable const& mesh_options() { return once<make_mesh_options>(); }

}  // namespace boltzmann
