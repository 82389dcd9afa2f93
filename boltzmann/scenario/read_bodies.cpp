// Reads [[bodies]]: solid bodies in a plane flow.
#include <boltzmann/pictures/colour.hpp>
#include <boltzmann/scenario/class_variant.hpp>
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/schemes/cylinder/cylinder_flow.hpp>
#include <boltzmann/schemes/panels/body_options.hpp>
#include <boltzmann/simulation/no_slip.hpp>
#include <boltzmann/simulation/outside_bodies.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace boltzmann {
namespace {

/// Creates an ensemble of panels from one table.
void read_body(Item const& table, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  Section section(table, "[[bodies]]", reading.context);
  BodyOptions options;
  Item const* word = section.need("shape", "shape = \"circle\"");
  auto const shape = word ? read_word(*word, "shape", body_shape_words(), reading.context) : std::nullopt;
  if (!shape) return;
  section.rename(fmt::format("[[bodies]] '{}'", body_shape_words().name(*shape)));
  read_options(section, body_options(*shape), &options, {.dimension = reading.dimension});
  section.finish();
  for (auto const& other : reading.ensembles)
    if (other.name == options.name)
      reading.mistake(section.place("name"), fmt::format("name: there is '{}' already, in line {}; names must differ",
                                                         options.name, other.place.line));
  catch_errors(reading, section.place("colour"), [&] {
    if (!options.appearance.colour.empty()) colour_named(options.appearance.colour);
  });
  ReadEnsemble read;
  read.name = options.name;
  read.place = read.load_place = table.place;
  read.kind = &body_class();
  if (reading.context.mistakes.count() == before && reading.box)
    catch_errors(reading, table.place, [&] {
      reading.bodies_place = table.place;
      if (!reading.bodies) reading.bodies = std::make_unique<PanelScheme>(*reading.box);
      auto body = std::make_unique<Ensemble<Panel<2>>>(options.name);
      body->appearance = options.appearance;
      reading.bodies->add_body(*body, outline_of(options), options.sheet);
      if (section.has("no_slip"))
        reading.sticky_bodies.push_back(
            {reading.bodies->bodies().size() - 1, {options.no_slip, section.place("no_slip")}});
      read.particles = body.get();
      read.integrator = usual_integrator(*body);
      reading.result->ensembles.push_back(std::move(body));
    });
  reading.ensembles.push_back(std::move(read));
}

}  // namespace

ParticleClass const& body_class() {
  static ParticleClass const panel{
      "Panel",
      "a piece of the outline of a body",
      false,
      {{2,
        [](std::string name, std::size_t size) -> std::unique_ptr<AnyEnsemble> {
          return std::make_unique<Ensemble<Panel<2>>>(std::move(name), size);
        },
        [](AnyEnsemble& ensemble, Method) { return usual_integrator(ensemble); }, Panel<2>::fields().fields,
        sizeof(Row<Panel<2>>) + sizeof(Panel<2>::Influence), Method::deactivate, source_kind<Panel<2>>()}}};
  return panel;
}

void read_bodies(Section& document, Reading& reading) {
  for (Item const* table : find_tables(document, "bodies")) read_body(*table, reading);
}

void load_bodies(Reading& reading) {
  if (!reading.bodies) return;
  if (reading.result->scheme<CylinderFlow>())
    return reading.mistake(
        reading.bodies_place,
        "[[bodies]] and [cylinder_flow] don't go together: images know nothing of other bodies; make "
        "the cylinder one of the bodies, shape = \"circle\"");
  for (auto const& ensemble : reading.ensembles) {
    if (!ensemble.particles || ensemble.kind == &body_class() || ensemble.kind->classical) continue;
    if (ensemble.integrator && ensemble.integrator->method() == Method::deactivate) continue;
    catch_errors(reading, ensemble.place, [&] { reading.bodies->add(*ensemble.particles); });
  }
  try {
    check_outside(*reading.bodies);
  } catch (Error const& error) {
    reading.mistake(place_of(error.what(), reading), error.what());
  }
  reading.bodies->threads(reading.run.threads);
  reading.result->schemes.push_back(std::move(reading.bodies));
}

void add_bodies(Reading& reading) {
  auto* const bodies = reading.result->scheme<PanelScheme>();
  if (!bodies) return;
  std::vector<AnyEnsemble*> done;
  for (auto const& [first, to] : reading.sticky_bodies) {
    std::vector<std::size_t> which;
    for (auto const& other : reading.sticky_bodies)
      if (other.second.first == to.first) which.push_back(other.first);
    AnyEnsemble* vortices = nullptr;
    for (auto const& ensemble : reading.ensembles)
      if (ensemble.name == to.first && ensemble.kind != &body_class()) vortices = ensemble.particles;
    if (!vortices) {
      reading.mistake(to.second, fmt::format("no_slip: there is no ensemble '{}'", to.first));
      continue;
    }
    if (std::find(done.begin(), done.end(), vortices) != done.end()) continue;
    done.push_back(vortices);
    catch_errors(reading, to.second,
                 [&] { reading.result->simulation->adapt(1, NoSlip(*bodies, *vortices, which, *reading.run.step)); });
  }
}

void keep_out_of_bodies(Reading const& reading) {
  if (auto* const bodies = reading.result->scheme<PanelScheme>())
    reading.result->simulation->adapt(1, OutsideBodies(*bodies));
}

}  // namespace boltzmann
