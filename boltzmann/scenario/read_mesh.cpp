// Reads [mesh]: the field of the particles on a mesh; without it, schemes are pairs only.
#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/scenario/laws.hpp>
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/schemes/mesh/mesh_options.hpp>
#include <boltzmann/schemes/mesh/p3m_scheme.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace boltzmann {

namespace {

FieldBoundary read_end(Item const& item, Reading& reading) {
  return read_word(item, "boundary", field_boundary_words(), reading.context).value_or(FieldBoundary::periodic);
}

/// One word for all axes, or for each axis a word or two of them, for its low and its high end.
void read_boundary(Item const& item, MeshScheme& mesh, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  auto const set = [&](int axis, Place const& place, FieldBoundary low, FieldBoundary high) {
    if (reading.context.mistakes.count() == before)
      catch_errors(reading, place, [&] { mesh.boundary(axis, low, high); });
  };
  auto const dimension = static_cast<std::size_t>(reading.dimension);
  if (item.is(Item::Kind::text)) {
    FieldBoundary const all = read_end(item, reading);
    for (int a = 0; a < reading.dimension; ++a) set(a, item.place, all, all);
    return;
  }
  if (!item.is(Item::Kind::array) || item.elements.size() != dimension) {
    reading.mistake(item.place,
                    fmt::format("boundary: a word, or an array with a word or a pair [low, high] for each of the {} "
                                "axes is needed, not {}{}",
                                dimension, describe(item),
                                item.is(Item::Kind::array) ? fmt::format(" of {}", item.elements.size()) : ""));
    return;
  }
  for (std::size_t a = 0; a < dimension; ++a) {
    Item const& axis = item.elements[a];
    if (axis.is(Item::Kind::array)) {
      if (axis.elements.size() != 2) {
        reading.mistake(axis.place, "boundary: an axis has two ends, [low, high]");
        return;
      }
      FieldBoundary const low = read_end(axis.elements[0], reading), high = read_end(axis.elements[1], reading);
      set(static_cast<int>(a), axis.place, low, high);
    } else {
      FieldBoundary const both = read_end(axis, reading);
      set(static_cast<int>(a), axis.place, both, both);
    }
  }
}

void read_plain_mesh(Section& section, MeshOptions const& options, LaplaceLaw const& law, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  Item const *cells = section.need("cells", "cells = 64"), *boundary = section.find("boundary");
  if (options.cells.empty()) return;
  catch_errors(reading, cells->place, [&] {
    auto mesh = std::make_unique<MeshScheme>(*reading.box, options.cells, law);
    mesh->assignment(options.assignment);
    mesh->form(options.poisson);
    mesh->precision(options.precision);
    if (boundary) read_boundary(*boundary, *mesh, reading);
    if (reading.context.mistakes.count() == before) mesh->grid();  // throws if there is not enough memory
    reading.result->schemes.push_back(std::move(mesh));
  });
}

}  // namespace

void read_mesh(Item const& table, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  Section section(table, "[mesh]", reading.context);
  reading.mesh.background_place = section.place("background");
  auto const law = read_field_law(section, mesh_options(), reading);
  MeshOptions options;
  read_options(section, keys_but_of_the_law(mesh_options()), &options, {.dimension = reading.dimension});
  if (section.has("accuracy")) {
    for (char const* key : {"cells", "assignment", "poisson", "precision", "boundary"})
      section.refuse(key, "with 'accuracy' it is chosen by the scheme; leave it out");
    reading.mesh.bonded_place = section.place("bonded_factors");
    reading.mesh.bonded_factors = options.bonded_factors;
    section.finish();
    if (law && options.accuracy && reading.box)
      catch_errors(reading, section.place("accuracy"), [&] {
        reading.result->schemes.push_back(std::make_unique<P3MScheme>(*reading.box, *law, *options.accuracy));
      });
  } else {
    section.refuse("bonded_factors", "it belongs to 'accuracy': a mesh alone does not know single pairs");
    if (law && reading.box) read_plain_mesh(section, options, *law, reading);
    section.finish();
  }
  if (auto* mesh = reading.result->scheme<MeshScheme>()) mesh->background(options.background);
  reading.mesh.usable = reading.context.mistakes.count() == before;
}

namespace {

/// The interaction of two charges at the distance r, times a factor that subtracts a part of it.
FormulaLaw less_by(double part, double constant, int dimension) {
  double const turns = dimension == 3 ? 4 * pi : dimension == 2 ? 2 * pi : 2;
  char const* const energy = dimension == 3   ? "k*p.charge*q.charge/r"
                             : dimension == 2 ? "-k*p.charge*q.charge*log(r)"
                                              : "-k*p.charge*q.charge*r";
  return FormulaLaw::energy(energy, {{"k", -part * constant / turns}});
}

/// For bonded charges, subtracts all or part of their interaction by the mesh and its pairs (the nearest images).
void add_bonded_factors(MeshScheme& mesh, Reading& reading) {
  auto const& factors = reading.mesh.bonded_factors;
  bool bonded = false;
  for (auto const& ensemble : reading.ensembles) {
    if (!ensemble.particles || ensemble.molecules.bonds.empty()) continue;
    bonded = true;
    catch_errors(reading, reading.mesh.bonded_place, [&] {
      if (!ensemble.particles->find_field("charge"))
        throw Error(fmt::format("bonded_factors: class {} has no charge", ensemble.particles->class_name()));
      for (std::size_t k = 0; k < factors.size(); ++k) {
        auto const pairs = pairs_apart(ensemble.molecules.bonds, k + 1);
        if (factors[k] == 1 || pairs.empty()) continue;
        mesh.pairs().connect(*ensemble.particles, connections_of(pairs),
                             less_by(1 - factors[k], mesh.constant(), ensemble.particles->dimension()));
      }
    });
  }
  if (!factors.empty() && !bonded && all_loaded(reading))
    reading.mistake(reading.mesh.bonded_place,
                    "bonded_factors: no ensemble has bonds; [[ensembles]] give them, bonds = \"chain\"");
}

}  // namespace

void add_to_mesh(Item const& table, Reading& reading) {
  auto* const mesh = reading.result->scheme<MeshScheme>();
  if (!mesh) return;
  auto const add = [&](AnyEnsemble& ensemble, SourceKind const& kind) { mesh->add(ensemble, kind); };
  if (!add_sources(table, "[mesh]", LaplaceLaw{mesh->constant()}, add, reading)) reading.mesh.usable = false;
  add_bonded_factors(*mesh, reading);
}

bool find_mesh_fields(Reading& reading, Place const& place, std::string_view what) {
  if (!reading.mesh.usable) return false;
  if (!reading.mesh.fields.empty()) return true;
  std::vector<Scheme*> schemes;
  for (auto const& scheme : reading.result->schemes) schemes.push_back(scheme.get());
  for (auto const& ensemble : reading.ensembles)
    if (!ensemble.particles) return false;
  try {
    reading.mesh.fields = mesh_fields_of(schemes);
    // an error of the user's input or, if particles are outside, of the physics
  } catch (std::runtime_error const& failure) {
    reading.mistake(place_of(failure.what(), reading), failure.what());
    return reading.mesh.usable = false;
  }
  if (!reading.mesh.fields.empty()) return true;
  reading.mistake(place,
                  fmt::format("{} needs a mesh, but the scenario has no [mesh], and no 'grid' in [multipole]", what));
  return reading.mesh.usable = false;
}

}  // namespace boltzmann
