// The members of mesh schemes with their keys.
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
  all.add_said("cells", "a whole number, or a list with one for each axis", "of the mesh",
               "needed, but with `accuracy`");
  all.add_of<M>(
      "assignment", [](M& m) -> OptionPlace { return named_value(&m.assignment, assignment_words()); },
      word(assignment_words().names()), "how particles are spread over nodes");
  all.add_of<M>(
      "poisson", [](M& m) -> OptionPlace { return named_value(&m.poisson, poisson_form_words()); },
      word(poisson_form_words().names()), "Poisson's equation on the mesh");
  all.add_said("boundary", join(field_boundary_words().names()) + "; a word, or for each axis a word or a pair",
               "of the field", "periodic where the box is, elsewhere open");
  all.add("background", &M::background, flag(), "a uniform background makes the whole neutral");
  all.add_of<M>(
      "precision", [](M& m) -> OptionPlace { return named_value(&m.precision, precision_words()); },
      word(precision_words().names()), "of the particles during a run");
  all.add("accuracy", &M::accuracy, number(dimensions::none, positive),
          "P3M: mesh plus near pairs, forces to this part of their rms; `cells`, `assignment`, `poisson`, `boundary` "
          "and `precision` are then chosen for you",
          "a mesh alone");
  all.add_said(
      "bonded_factors", "a list of numbers, `[0, 0, 0.5]`",
      "with `accuracy`: of charges 1, 2, 3, ... bonds apart (`bonds` of `[[ensembles]]`); 0: they don't act on "
      "each other",
      "1: as all others");
  return all;
}

}  // namespace

OptionTable const& mesh_options() { return once<make_mesh_options>(); }

}  // namespace boltzmann
