// A program's run becomes ensembles with fields, and a scheme with the box.
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/particles/stored_ensemble.hpp>
#include <boltzmann/pictures/picture_options.hpp>
#include <boltzmann/recording/run_file.hpp>
#include <boltzmann/scenario/document.hpp>
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/section.hpp>
#include <boltzmann/scenario/stored_run.hpp>

#include <filesystem>
#include <utility>

namespace boltzmann {
namespace {

namespace fs = std::filesystem;

/// A scheme with the box and the ensembles, without laws.
class StoredScheme final : public Scheme {
 public:
  using Scheme::Scheme;
  void add_influences(double /*time*/) override {}
  EnergyAndVirial measure(double /*time*/) override {
    EnergyAndVirial measures;
    measures.unknown = "a stored run of a program";
    measures.no_virial = "a stored run of a program has no laws";
    return measures;
  }
  double length_scale(AnyEnsemble const& /*ensemble*/) const override { return __builtin_inf(); }
  std::string explain(AnyEnsemble const& /*ensemble*/, std::size_t /*i*/) const override { return ""; }
  void make_reversible(double /*quantum*/) override { throw Error("a stored run can't be run backwards"); }
};

/// Reads the tables of a run file.
struct RunReader {
  ReadContext& context;

  std::array<double, 3> place(Section& section, char const* key, int dimension) {
    std::array<double, 3> place{};
    if (section.need(key, "low = [0, 0]"))
      if (auto const numbers = section.vector(key, dimension, dimensions::none))
        std::copy(numbers->begin(), numbers->end(), place.begin());
    return place;
  }

  void take(Section& section, char const* word, std::string& text) {
    if (auto const read = section.text(word)) text = *read;
  }
  void take(Section& section, char const* word, double& number) {
    if (auto const read = section.quantity(word, dimensions::none)) number = *read;
  }

  UnitSystem read_units(Section& top) {
    Item const* table = find_table(top, "units");
    if (!table) return UnitSystem::reduced();
    Section section(*table, "[units]", context);
    std::array<double, 5> si{};
    std::size_t k = 0;
    for (char const* key : {"length", "mass", "time", "temperature", "charge"})
      si[k++] = section.need_quantity(key, dimensions::none, "length = 1e-10", positive).value_or(1);
    bool const reduced = section.boolean("reduced");
    section.finish();
    if (reduced) return UnitSystem::reduced();
    return {Quantity<dimensions::length>{si[0]}, Quantity<dimensions::mass>{si[1]}, Quantity<dimensions::time>{si[2]},
            Quantity<dimensions::temperature>{si[3]}, Quantity<dimensions::charge>{si[4]}};
  }

  std::optional<Box> box(Section& top) {
    Item const* table = find_table(top, "box");
    if (!table) {
      context.mistakes.add(top.place(), "there is no [box]");
      return std::nullopt;
    }
    Section section(*table, "[box]", context);
    std::vector<std::string> kinds;
    Item const* item = section.need("boundary", "boundary = [\"open\"]");
    if (!item) return std::nullopt;
    kinds = read_texts(*item, "boundary", context);
    int const D = static_cast<int>(kinds.size());
    if (D < 1 || D > 3) {
      context.mistakes.add(section.place("boundary"), "boundary: one to three words are needed");
      return std::nullopt;
    }
    std::array<Boundary, 3> boundaries{};
    for (std::size_t a = 0; a < kinds.size(); ++a) {
      try {
        boundaries[a] = boundary_words().named(kinds[a]);
      } catch (Error const&) {
        context.mistakes.add(section.place("boundary"), "boundary: unknown word " + boltzmann::quoted(kinds[a]));
      }
    }
    auto const low = place(section, "low", D), high = place(section, "high", D);
    if (!context.mistakes.none()) return std::nullopt;
    Box box(D, low, high, boundaries);
    for (Item const* one : find_tables(section, "walls")) add_wall(box, *one);
    if (Item const* shear = find_table(section, "shear")) add_shear(box, *shear);
    for (Item const* one : find_tables(section, "regions")) {
      Section region(*one, "[[box.regions]]", context);
      auto const from = place(region, "low", D), to = place(region, "high", D);
      auto const keep = region.word("keep", {"in", "out"});
      region.finish();
      if (context.mistakes.none())
        box.install(Region{from, to, keep == "in" ? Region::Side::keep_in : Region::Side::keep_out});
    }
    section.finish();
    return box;
  }

  void add_wall(Box& box, Item const& table) {
    Section section(table, "[[box.walls]]", context);
    int const axis = static_cast<int>(section.integer("axis", 0, box.dimension() - 1).value_or(0));
    auto const end = section.word("end", {"low", "high"}) == "low" ? Box::End::low : Box::End::high;
    if (section.boolean("open")) {
      section.finish();
      if (context.mistakes.none()) box.open_end(axis, end);
      return;
    }
    Wall wall;
    wall.slips = section.boolean("slips", true);
    wall.velocity = place(section, "velocity", box.dimension());
    if (auto const temperature = section.quantity("temperature", dimensions::none)) wall.temperature = *temperature;
    section.finish();
    if (context.mistakes.none()) box.wall(axis, end, wall);
  }

  void add_shear(Box& box, Item const& table) {
    Section section(table, "[box.shear]", context);
    Shear shear;
    shear.rate = section.need_quantity("rate", dimensions::none, "rate = 0.1").value_or(0);
    shear.flow = static_cast<int>(section.integer("flow", 0, 2).value_or(0));
    shear.gradient = static_cast<int>(section.integer("gradient", 0, 2).value_or(1));
    section.finish();
    if (context.mistakes.none()) box.shear(shear);
  }

  /// Fields are contiguous, independent of their layout in the program.
  std::unique_ptr<AnyEnsemble> ensemble(Item const& table, int dimension) {
    Section section(table, "[[ensembles]]", context);
    std::string name, class_name;
    Appearance appearance;
    take(section, "name", name);
    take(section, "class", class_name);
    take(section, "colour", appearance.colour);
    take(section, "diameter", appearance.diameter);
    std::vector<Field> fields;
    int doubles = 0;
    for (Item const* one : find_tables(section, "fields")) {
      Section of_field(*one, "fields", context);
      Field field{"", doubles, 1, dimensions::none, ""};
      take(of_field, "name", field.name);
      take(of_field, "doc", field.doc);
      field.components = static_cast<int>(of_field.integer("components", 1, 9).value_or(1));
      if (Item const* item = of_field.need("dimension", "dimension = [1, 0, -1, 0, 0]")) {
        std::array<signed char, 5> powers{};
        if (item->elements.size() == 5)
          for (std::size_t k = 0; k < 5; ++k)
            powers[k] =
                static_cast<signed char>(read_integer(item->elements[k], "dimension", -127, 127, context).value_or(0));
        else
          context.mistakes.add(item->place, "dimension: five exponents are needed");
        field.dimension = {powers[0], powers[1], powers[2], powers[3], powers[4]};
      }
      of_field.finish();
      doubles += field.components;
      fields.push_back(std::move(field));
    }
    section.finish();
    if (fields.empty() || fields[0].name != "position" || fields[0].components != dimension) {
      context.mistakes.add(section.place("fields"), "fields: the first is the position, with one component an axis");
      return nullptr;
    }
    auto ensemble = std::make_unique<StoredEnsemble>(name, class_name, dimension, static_cast<std::size_t>(doubles),
                                                     std::move(fields));
    ensemble->appearance = appearance;
    return ensemble;
  }

  void read(Item const& document, ScenarioSimulation& run) {
    Section top(document, "the run", context);
    take(top, "title", run.title);
    double const step = top.quantity("step", dimensions::none).value_or(1);
    run.units = read_units(top);
    run.reduced = run.units.is_reduced();
    auto const space = box(top);
    top.allow("ensembles");
    if (space)
      for (Item const* table : find_tables(top, "ensembles"))
        if (auto particles = ensemble(*table, space->dimension())) run.ensembles.push_back(std::move(particles));
    for (Item const* table : find_tables(top, "pictures")) {
      Section section(*table, "[[pictures]]", context);
      PicturePlan plan;
      read_options(section, picture_options(), static_cast<Picture*>(&plan),
                   {space ? space->dimension() : 0, [] { return std::optional(dimensions::none); }});
      section.finish();
      run.output.pictures.push_back(std::move(plan));
    }
    top.finish();
    if (!context.mistakes.none()) return;
    auto scheme = std::make_unique<StoredScheme>(*space);
    for (auto const& ensemble : run.ensembles) scheme->add(*ensemble);
    run.simulation = std::make_unique<Simulation>(*scheme, step);
    run.schemes.push_back(std::move(scheme));
    run.simulation->speak_in(run.units);
  }
};

std::unique_ptr<ScenarioSimulation> load_program_run(std::string const& path) {
  Mistakes mistakes(path);
  auto run = std::make_unique<ScenarioSimulation>();
  Item const document = parse_document(read_text(path), mistakes);
  check_letters(document, mistakes);
  ReadContext context{mistakes, UnitSystem::reduced(), "", nullptr};
  if (mistakes.none()) RunReader{context}.read(document, *run);
  if (!mistakes.none()) throw ScenarioErrors(mistakes.lines());
  return run;
}

std::string scenario_of(std::string const& folder) { return folder + "/scenario.toml"; }
std::string program_run_of(std::string const& folder) { return folder + "/" + run_file; }

bool there(std::string const& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

void need_run(std::string const& folder) {
  if (!holds_run(folder)) throw Error("'" + folder + "' holds no run: it has neither scenario.toml nor " + run_file);
}

}  // namespace

bool holds_run(std::string const& folder) { return there(scenario_of(folder)) || there(program_run_of(folder)); }

std::unique_ptr<ScenarioSimulation> load_stored_run(std::string const& folder) {
  need_run(folder);
  if (!there(scenario_of(folder))) return load_program_run(program_run_of(folder));
  auto run = load_scenario(scenario_of(folder));
  run->simulation->check();
  return run;
}

ScenarioOutline outline_stored_run(std::string const& folder) {
  need_run(folder);
  if (auto const path = scenario_of(folder); there(path)) return outline_scenario(read_text(path), path);
  auto const run = load_program_run(program_run_of(folder));
  ScenarioOutline outline;
  outline.title = run->title;
  outline.dimension = run->box().dimension();
  return outline;
}

}  // namespace boltzmann
