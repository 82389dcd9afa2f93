// The table of schemes. The influences of all schemes of a scenario are added. To add a scheme, add a table of options
// in its module, a reader and an entry here. Readers that depend on schemes (laws, friction, diagnoses, views) use
// `mesh` and `smooth` of reading.hpp.
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/scenario/schemes.hpp>
#include <boltzmann/schemes/cylinder/cylinder_flow.hpp>
#include <boltzmann/schemes/many_body/many_body_options.hpp>
#include <boltzmann/schemes/mesh/mesh_options.hpp>
#include <boltzmann/schemes/mesh/mesh_scheme.hpp>
#include <boltzmann/schemes/multipole/multipole_options.hpp>
#include <boltzmann/schemes/smooth/smooth_options.hpp>

#include <algorithm>

namespace boltzmann {

std::vector<SchemeEntry> const& scheme_entries() {
  static MeshOptions mesh;
  static MultipoleOptions multipole;
  static CylinderOptions cylinder;
  static SmoothOptions smooth;
  static RezoneOptions rezone;
  static EmbeddedAtomOptions embedded_atoms;
  static StillingerWeberOptions stillinger_weber;
  static std::vector<SchemeEntry> const all = {
      {{"mesh", "[mesh]", "charges or masses influence each other through a field on a mesh", &mesh_options(), &mesh},
       {},
       read_mesh,
       add_to_mesh},
      {{"multipole", "[multipole]", "charges, masses or vortices influence each other, by expansions over a tree",
        &multipole_options(), &multipole},
       {},
       read_multipole,
       add_to_multipole},
      {{"cylinder_flow", "[cylinder_flow]", "a cylinder in 2D, past which a stream and vortices flow, by images",
        &cylinder_options(), &cylinder},
       {},
       read_cylinder,
       add_to_cylinder},
      {{"smooth", "[smooth]", "the particles are pieces of a continuum", &smooth_options(), &smooth},
       {{"smooth.rezone", "[[smooth.rezone]]", "splits and merges smooth particles during the run", &rezone_options(),
         &rezone}},
       read_smooth,
       add_to_smooth},
      {{"embedded_atoms", "[embedded_atoms]", "metals: atoms in the density that their neighbours make",
        &embedded_atom_options(), &embedded_atoms},
       {},
       read_embedded_atoms,
       add_to_embedded_atoms},
      {{"stillinger_weber", "[stillinger_weber]", "silicon and its like: atoms with bonds at given angles",
        &stillinger_weber_options(), &stillinger_weber},
       {},
       read_stillinger_weber,
       add_to_stillinger_weber}};
  return all;
}

void read_schemes(Section& document, Reading& reading) {
  for (auto const& entry : scheme_entries()) {
    std::size_t const before = reading.context.mistakes.count();
    Item const* table = find_table(document, entry.told.name);
    if (reading.context.mistakes.count() != before) reading.mesh.usable = false;  // it may be intended as a mesh
    if (!table) continue;
    reading.schemes.emplace_back(&entry, table);
    entry.read(*table, reading);
  }
  for (auto const& scheme : reading.result->schemes) scheme->threads(reading.run.threads);
}

namespace {

/// Pair interactions of particles that are not smooth, and external laws; a mesh has its own.
void load_pairs(Reading& reading) {
  ScenarioSimulation& result = *reading.result;
  bool const needed = !reading.smooth.wanted ||
                      std::any_of(reading.ensembles.begin(), reading.ensembles.end(), [](ReadEnsemble const& ensemble) {
                        bool const driven = ensemble.particles && !ensemble.particles->driven().empty();
                        return !ensemble.smooth() || driven;
                      });
  if (auto* mesh = result.scheme<MeshScheme>()) {
    result.pairs = &mesh->pairs();
  } else if (needed && reading.box) {
    auto pairs = std::make_unique<PairScheme>(*reading.box, reading.run.cutoff.value_or(no_cutoff));
    pairs->threads(reading.run.threads);
    result.pairs = pairs.get();
    result.schemes.push_back(std::move(pairs));
  }
  if (!needed && reading.run.cutoff)
    reading.mistake(reading.run.cutoff_place,
                    "cutoff: smooth particles act as far as their 'range', a field of the ensembles; leave it out");
  if (!needed && reading.run.skin)
    reading.mistake(reading.run.skin_place, "skin: for smooth particles set it in [smooth]");
  if (!result.pairs) return;
  if (reading.run.skin) result.pairs->skin(*reading.run.skin);
  if (!reading.run.shifted) result.pairs->shifted(false);
  // Particles without a law belong to it, too.
  for (auto const& ensemble : reading.ensembles)
    if (ensemble.particles && !ensemble.smooth())
      catch_errors(reading, ensemble.place, [&] { result.pairs->add(*ensemble.particles); });
}

}  // namespace

void load_schemes(Reading& reading) {
  for (auto const& [entry, table] : reading.schemes) entry->add(*table, reading);
  load_pairs(reading);
}

}  // namespace boltzmann
