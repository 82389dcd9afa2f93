// Converts the text of a scenario to a simulation: reads the tables in order, and reports all mistakes together.
#include <boltzmann/core/input_file.hpp>
#include <boltzmann/pictures/picture.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/scenario/schemes.hpp>
#include <boltzmann/scenario/sweep_values.hpp>
#include <boltzmann/simulation/refusals.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <new>

namespace boltzmann {
namespace {

std::string all_lines(std::vector<std::string> const& lines) {
  std::string text;
  for (auto const& line : lines) text += (text.empty() ? "" : "\n") + line;
  return text;
}

void read_tables(Item& document, Reading& reading) {
  Section top(document, "the scenario", reading.context);
  reading.result->title = top.text("title").value_or("");
  reading.result->description = top.text("description").value_or("");
  read_units(top, reading);
  read_box(top, reading);
  read_run(top, reading);
  read_schemes(top, reading);
  read_classes(top, reading);
  read_ensembles(top, reading);
  read_bodies(top, reading);
  load_schemes(reading);
  load_rezone(reading);
  load_rates(reading);
  load_neighbour_fields(reading);
  read_dyes(top, reading);
  read_influences(top, reading);
  read_rigid_bonds(top, reading);
  load_bodies(reading);
  read_adaptations(top, reading);
  settle_run(document, reading);
  read_dissipations(top, reading);
  read_barostats(top, reading);
  read_events(top, reading);
  read_relaxation(top, reading);
  read_minimise(top, reading);
  read_diagnoses(top, reading);
  read_output(top, document, reading);
  read_stop(reading);
  read_views(top, reading);
  read_sweep(top, reading);
  top.finish();
}

void make_simulation(Reading& reading) {
  ScenarioSimulation& result = *reading.result;
  result.steps = reading.run.steps;
  result.simulation = std::make_unique<Simulation>(*result.schemes.front(), *reading.run.step);
  for (std::size_t k = 1; k < result.schemes.size(); ++k) result.simulation->add(*result.schemes[k]);
  for (auto const& [slow, steps] : reading.slow) result.simulation->every(steps, *slow);
  result.simulation->seed(reading.run.seed);
  result.simulation->speak_in(result.units);
}

/// Adds integrators and adaptations.
void complete_simulation(Reading& reading) {
  ScenarioSimulation& result = *reading.result;
  bool const radau = std::any_of(reading.ensembles.begin(), reading.ensembles.end(), [](ReadEnsemble const& ensemble) {
    return ensemble.integrator && ensemble.integrator->method() == Method::gauss_radau;
  });
  if (reading.run.tolerance && !radau)
    reading.mistake(reading.run.tolerance_place,
                    "tolerance: it is that of gauss-radau, by which no ensemble moves; write integrator = "
                    "\"gauss-radau\" in [[ensembles]]");
  else if (reading.run.tolerance)
    result.simulation->tolerance(*reading.run.tolerance);
  if (reading.run.substeps) result.simulation->divide_steps(*reading.run.substeps);
  for (auto& ensemble : reading.ensembles)
    result.simulation->integrate(*ensemble.particles, std::move(ensemble.integrator));
  add_dissipations(reading);
  for (auto const& follow : reading.behind_baths) follow(*result.simulation);
  add_barostats(reading);
  add_events(reading);
  add_rezoners(reading);
  add_relaxation(reading);
  add_minimisation(reading);
  add_bodies(reading);
  for (auto const& adapt : reading.adaptations) adapt(*result.simulation);
  add_dyes(reading);
  keep_out_of_bodies(reading);
  result.simulation->threads(reading.run.threads);  // including baths and friction
}

void check_simulation(Reading& reading) {
  ScenarioSimulation const& result = *reading.result;
  try {
    result.simulation->check();
    for (auto const& place : reading.track_places)
      catch_errors(reading, place, [&] { check_tracks(*result.simulation); });
    auto const lines = refusals(*result.simulation, result.diagnoses);
    for (std::size_t d = 0; d < lines.size(); ++d)
      if (!lines[d].empty()) reading.mistake(reading.diagnosis_places[d], lines[d]);
  } catch (Error const& error) {
    reading.mistake(place_of(error.what(), reading), error.what());
  } catch (PhysicsFailure const& failure) {
    reading.mistake(place_of(failure.what(), reading), failure.what());
  }
}

/// True if one of its texts names an influence.
bool reads_influences(Item const& item) {
  return item.text.find("influence") != std::string::npos ||
         std::any_of(item.elements.begin(), item.elements.end(), reads_influences) ||
         std::any_of(item.entries.begin(), item.entries.end(),
                     [](Entry const& entry) { return reads_influences(entry.item); });
}

void build(Item& document, Reading& reading) {
  read_tables(document, reading);
  if (!reading.context.mistakes.none()) return;
  catch_errors(reading, reading.run.place, [&] { make_simulation(reading); });
  if (!reading.result->simulation) return;
  complete_simulation(reading);
  if (Entry const* diagnoses = document.find("diagnoses"); diagnoses && reads_influences(diagnoses->item))
    reading.result->simulation->observers_read_influences();
  check_simulation(reading);
  if (reading.context.mistakes.none()) settle_velocities(reading);
}

/// [run] steps and time are alternatives: the command line overrides the file.
void settle_length(Item& document) {
  Entry* run = document.find("run");
  if (!run || !run->item.is(Item::Kind::table)) return;
  Entry const *steps = run->item.find("steps"), *time = run->item.find("time");
  if (!steps || !time) return;
  int const of_steps = steps->item.place.override_number, of_time = time->item.place.override_number;
  if (of_steps == of_time) return;
  std::string const loser = of_steps > of_time ? "time" : "steps";
  std::erase_if(run->item.entries, [&](Entry const& entry) { return entry.key == loser; });
}

std::unique_ptr<ScenarioSimulation> parse(std::string const& text, std::string const& file, std::string const& name,
                                          std::string const& folder, Overrides const& overrides) {
  Mistakes mistakes(file);
  Item document = parse_document(text, mistakes);
  if (!mistakes.none()) throw ScenarioErrors(mistakes.lines());
  for (auto const& assignment : overrides.set) apply_override(document, assignment, "--set", mistakes);
  for (auto const& path : overrides.without) leave_out(document, path);
  if (overrides.steps) apply_override(document, fmt::format("run.steps={}", *overrides.steps), "--steps", mistakes);
  if (overrides.seed) {
    // TOML's integers end at 2^63 - 1.
    if (*overrides.seed > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
      throw ScenarioErrors({fmt::format("--seed={}: it is out of range; it must be between 0 and {}", *overrides.seed,
                                        std::numeric_limits<std::int64_t>::max())});
    apply_override(document, fmt::format("run.seed={}", *overrides.seed), "--seed", mistakes);
  }
  if (overrides.threads)
    apply_override(document, fmt::format("run.threads={}", *overrides.threads), "--threads", mistakes);
  if (overrides.seeds) apply_override(document, fmt::format("sweep.seeds={}", *overrides.seeds), "--seeds", mistakes);
  settle_length(document);
  if (overrides.no_sweep) std::erase_if(document.entries, [](Entry const& entry) { return entry.key == "sweep"; });
  override_vary(document, overrides.vary, mistakes);
  if (!overrides.by_page) refuse_varied(document, mistakes);
  check_letters(document, mistakes);
  if (!mistakes.none()) throw ScenarioErrors(mistakes.lines());
  if (Entry const* run = document.find("run"); run && run->item.is(Item::Kind::table))
    set_default(document, "run", "seed", Item::of_integer(1));
  std::string const sweep = document.find("sweep") ? sweep_text(document, folder) : "";
  std::string const files = sweep.empty() ? "" : folder_of_sweep(document);
  if (overrides.sweep_run) choose_run(document, *overrides.sweep_run, mistakes);
  if (!mistakes.none()) throw ScenarioErrors(mistakes.lines());

  KeyNotes notes(document, text, overrides.by_page);
  Reading reading{{mistakes, UnitSystem::si(), files.empty() ? folder : files, &notes, overrides.by_page},
                  std::make_unique<ScenarioSimulation>(),
                  true,
                  0,
                  {},
                  {},
                  {},
                  {},
                  {},
                  {}};
  reading.result->name = name;
  try {
    build(document, reading);
  } catch (std::bad_alloc const&) {
    throw Error(fmt::format("{}: the scenario needs more memory than this machine has", file));
  }
  if (!mistakes.none()) throw ScenarioErrors(mistakes.lines(), notes.absent(), notes.parameters());
  if (reading.result->sweep) reading.result->sweep->text = sweep;
  reading.result->resolved = write_document(document);
  reading.result->parameters = notes.parameters();
  reading.result->absent = notes.absent();
  return std::move(reading.result);
}

}  // namespace

Place place_of(std::string const& message, Reading const& reading) {
  if (message.starts_with("shear: ")) return reading.shear_place;
  bool const of_step = message.starts_with("the step ");
  for (auto const& ensemble : reading.ensembles)
    if (!of_step && message.find("'" + ensemble.name + "'") != std::string::npos) return ensemble.load_place;
  if (message.starts_with("the skin "))
    return reading.smooth.wanted && !reading.run.skin ? reading.smooth.skin_place : reading.run.skin_place;
  if (of_step) return reading.run.step_place;
  if (message.starts_with("substeps") || message.starts_with("steps ")) return reading.run.substeps_place;
  if (message.starts_with("mesh: ")) return reading.mesh.background_place;
  if (message.starts_with("barostat: ") && !reading.barostats.empty()) return reading.barostats.front().place;
  for (auto const& [entry, table] : reading.schemes)
    if (entry->told.name == "multipole" && message.starts_with("multipoles: ")) return table->place;
  return reading.run.place;
}

void add_diagnosis(std::unique_ptr<ScenarioSimulation>& scenario, ScenarioText const& text) {
  Mistakes mistakes(text.file);
  Item const document = parse_document(text.text, mistakes);
  if (!mistakes.none()) throw ScenarioErrors(mistakes.lines());
  Reading reading{{mistakes, scenario->units, text.folder}, std::move(scenario), true, 0, {}, {}, {}, {}, {}, {}};
  struct GiveBack {
    Reading& reading;
    std::unique_ptr<ScenarioSimulation>& owner;
    ~GiveBack() { owner = std::move(reading.result); }
  } const give_back{reading, scenario};
  ScenarioSimulation& result = *reading.result;
  reading.dimension = result.box().dimension();
  reading.box = result.box();
  for (auto const& ensemble : result.ensembles) {
    ReadEnsemble known;
    known.name = ensemble->name();
    known.kind = reading.find_class(ensemble->class_name());
    known.particles = ensemble.get();
    reading.ensembles.push_back(std::move(known));
  }
  std::size_t const before = result.diagnoses.size();
  Section top(document, "the scenario", reading.context);
  read_diagnoses(top, reading);
  top.finish();
  if (mistakes.none()) {
    auto const lines = refusals(*result.simulation, result.diagnoses);
    for (std::size_t d = before; d < lines.size(); ++d)
      if (!lines[d].empty()) reading.mistake(reading.diagnosis_places[d - before], lines[d]);
  }
  if (mistakes.none()) return;
  result.diagnoses.resize(before);
  throw ScenarioErrors(mistakes.lines());
}

ScenarioErrors::ScenarioErrors(std::vector<std::string> all, std::vector<ScenarioParameter> keys,
                               std::vector<ScenarioParameter> read)
    : Error(all_lines(all)), lines(std::move(all)), parameters(std::move(read)), absent(std::move(keys)) {}

ScenarioText read_scenario(std::string const& path) {
  namespace fs = std::filesystem;
  if (path == "-") {
    std::string const text((std::istreambuf_iterator<char>(std::cin)), std::istreambuf_iterator<char>());
    if (std::cin.bad()) throw Error("can't read standard input");
    if (text.empty()) throw Error("there is no scenario on standard input");
    return {text, "standard input", "stdin", ""};
  }
  need_regular_file(path);
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(fmt::format("can't read '{}': {}", path, std::strerror(errno == 0 ? EIO : errno)));
  std::string const text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  if (in.bad()) throw Error(fmt::format("can't read '{}'", path));
  fs::path const file(path);
  return {text, path, file.stem().string(), file.parent_path().string()};
}

std::unique_ptr<ScenarioSimulation> load_scenario(ScenarioText const& text, Overrides const& overrides) {
  return parse(text.text, text.file, text.name, text.folder, overrides);
}

std::unique_ptr<ScenarioSimulation> load_scenario(std::string const& path, Overrides const& overrides) {
  return load_scenario(read_scenario(path), overrides);
}

std::unique_ptr<ScenarioSimulation> parse_scenario(std::string const& text, std::string const& name,
                                                   Overrides const& overrides) {
  return parse(text, name, std::filesystem::path(name).stem().string(), "", overrides);
}

}  // namespace boltzmann
