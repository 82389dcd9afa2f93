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
  all.add("cells", &M::cells, wholes_by_axis(1, 1e9), "cells of the mesh", "needed without `accuracy`");
  all.add("assignment", &M::assignment, assignment_words(), "distribution of particles over nodes");
  all.add("poisson", &M::poisson, poisson_form_words(), "form of Poisson's equation on the mesh");
  all.add_said("boundary", join(field_boundary_words().names()) + "; a word, or for each axis a word or a pair",
               "boundary of the field", "periodic as the box, else open");
  all.add("background", &M::background, flag(), "a uniform background neutralises the whole");
  all.add("precision", &M::precision, precision_words(), "precision of particles during a run");
  all.add("accuracy", &M::accuracy, number(dimensions::none, positive),
          "P3M (mesh plus near pairs): force error relative to their rms; sets `cells`, `assignment`, `poisson`, "
          "`boundary` and `precision`",
          "a mesh alone");
  all.add("bonded_factors", &M::bonded_factors, numbers(dimensions::none),
          "with `accuracy`: factors of charges 1, 2, 3, ... bonds apart (`bonds` of `[[ensembles]]`), `[0, 0, 0.5]`; 0 "
          "excludes them",
          "1, as others");
  return all;
}

}  // namespace

OptionTable const& mesh_options() { return once<make_mesh_options>(); }

}  // namespace boltzmann
