// Reads [[dissipation]], friction and noise, and [equilibrate], which thermalises particles before the run.
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/dissipation/dissipation_options.hpp>
#include <boltzmann/dissipation/langevin_bath.hpp>
#include <boltzmann/dissipation/nose_hoover.hpp>
#include <boltzmann/dissipation/typed_friction.hpp>
#include <boltzmann/dissipation/velocity_rescaling.hpp>
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/scenario/tables.hpp>
#include <boltzmann/scenario/time_formula.hpp>
#include <boltzmann/schemes/mesh/mesh_scheme.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <string_view>
#include <utility>

namespace boltzmann {
namespace {

/// A longer equilibration is certainly a typing error.
constexpr double max_steps = 9e15;

/// Two ensembles (or one, twice) with dissipation of some kind, and its place in the file.
struct DissipatingPair {
  ReadEnsemble const *a, *b;
  Place place;
};

/// Data shared by the readers of single tables.
struct Dissipations {
  Reading& reading;
  PairDissipation* pairs = nullptr;  // all of them together
  std::optional<Place> first_dpd;
  DissipationOptions together;  // method, corrector and metropolis: those of the first table
  std::size_t number = 0;       // of the current table
  std::vector<DissipatingPair> dissipations, baths;
};

/// True if friction and noise can act on an ensemble; otherwise adds a mistake. Heat baths skip frozen particles.
bool supports(ReadEnsemble const& ensemble, Place const& place, std::string_view key, Reading& reading,
              bool spares_frozen = false) {
  AnyEnsemble const* particles = ensemble.particles;
  if (!particles || !ensemble.integrator) return false;
  auto const refuse = [&](std::string const& why) {
    reading.mistake(place, fmt::format("{}: friction and noise can't act on '{}': {}", key, ensemble.name, why));
    return false;
  };
  if (ensemble.smooth())
    return refuse("smooth particles have the viscosity and the conductivity of their material, and no other");
  if (!carries_momentum(*particles))
    return refuse(fmt::format("particles of class {} have no mass and velocity", ensemble.kind->name));
  if (ensemble.integrator->method() != Method::leap_frog)
    return refuse(
        fmt::format("they need integrator = \"leap-frog\", not \"{}\"", to_string(ensemble.integrator->method())));
  if (!spares_frozen && !ensemble.integrator->same_for_all())
    return refuse("some of its particles are frozen; put these into an ensemble of their own, or use a heat bath");
  return true;
}

/// Two dissipations of one kind on the same particles would have the same noise.
bool taken(std::vector<DissipatingPair>& list, ReadEnsemble const* a, ReadEnsemble const* b, Place const& place,
           std::string_view what, Reading& reading) {
  for (auto const& other : list)
    if ((other.a == a && other.b == b) || (other.a == b && other.b == a)) {
      reading.mistake(place, fmt::format("there is a {} dissipation {} already, in line {}", what,
                                         a == b ? fmt::format("of '{}'", a->name)
                                                : fmt::format("between '{}' and '{}'", a->name, b->name),
                                         other.place.line));
      return true;
    }
  list.push_back({a, b, place});
  return false;
}

/// `on` for one ensemble or `between` for two; nothing, and a mistake, if both are missing.
std::pair<ReadEnsemble*, ReadEnsemble*> read_pair(Section& section, Reading& reading) {
  section.explain_said(dissipation_pair_options());
  Item const *on = section.find("on"), *between = section.find("between");
  if (on || between) section.refuse(on ? "between" : "on", "'on' also chooses the ensembles; leave one out");
  if (!on && !between)
    reading.mistake(section.place(),
                    "[[dissipation]] does not name its ensembles: add on = \"atoms\" or between = [\"a\", \"b\"]");
  if ((on == nullptr) == (between == nullptr)) return {};
  if (on) {
    ReadEnsemble* one = reading.ensemble(*on, "on");
    return {one, one};
  }
  return two_ensembles(*between, reading);
}

/// method, corrector and metropolis belong in the first table of kind "dpd".
void check_method(Section& section, DissipationOptions const& options, Dissipations& all) {
  Reading& reading = all.reading;
  if (all.first_dpd) {
    for (char const* key : {"method", "corrector", "metropolis"})
      section.refuse(
          key,
          fmt::format("all dissipations of kind \"dpd\" act together and share this key; set it in the first (line {})",
                      all.first_dpd->line));
    return;
  }
  bool const splitting = options.method == DissipationMethod::shardlow;
  if (options.corrector && splitting)
    reading.mistake(section.place("corrector"), "corrector: it belongs to method = \"simultaneous\"");
  if (options.metropolis && !splitting)
    reading.mistake(section.place("metropolis"), "metropolis: it belongs to method = \"shardlow\"");
}

/// Checks the requirements of its convention on the temperature and on conduction.
void check_convention(Section& section, DissipationLaw const& dissipation, Reading& reading) {
  using enum Convention;
  std::string const name = to_string(dissipation.convention);
  if (dissipation.convention != constant_friction)
    section.need("temperature", reading.context.units.is_reduced() ? "temperature = 1" : "temperature = \"300 K\"");
  else
    section.refuse("temperature",
                   fmt::format("convention \"{}\" uses none but the particles' own; leave it out", name));
  if (dissipation.convention == fixed_temperature && dissipation.conduction > 0)
    reading.mistake(section.place("conduction"),
                    "conduction: with convention \"fixed-temperature\" particles have no temperatures of their own "
                    "between which heat could flow; another convention has");
}

/// True if the internal energy of each particle has a temperature; otherwise adds a mistake.
bool has_temperatures(ReadEnsemble const& ensemble, Place const& place, std::string_view convention, Reading& reading) {
  if (!has_internal_energy(*ensemble.kind)) {
    reading.mistake(place, fmt::format("convention: \"{}\" turns motion into internal energy; particles of class {} "
                                       "('{}') have none, those of class Meso have, and \"fixed-temperature\" does "
                                       "without",
                                       convention, ensemble.kind->name, ensemble.name));
    return false;
  }
  bool const reduced = reading.context.units.is_reduced();
  if (!ensemble.state) {
    reading.mistake(place, fmt::format("convention: \"{}\" needs the temperatures of internal energies; give '{}' a "
                                       "heat_capacity, e.g. heat_capacity = {}",
                                       convention, ensemble.name, reduced ? "16" : "\"16 kB\""));
    return false;
  }
  AnyEnsemble const& particles = *ensemble.particles;
  int const energy = particles.field("internal_energy").offset;
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (double const own = particles.row(i)[energy]; !(own > 0)) {
      reading.mistake(ensemble.place,
                      fmt::format("the internal energy of particle {} of '{}' is {}; it must be positive to have a "
                                  "temperature: add e.g. internal_energy = {{ temperature = {} }}",
                                  i, ensemble.name, own, reduced ? "1" : "\"300 K\""));
      return false;
    }
  return true;
}

/// True if a letter occurs in a text as a separate word.
bool has_word(std::string_view text, char letter) {
  auto const joins = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  for (std::size_t k = 0; k < text.size(); ++k)
    if (text[k] == letter && (k == 0 || !joins(text[k - 1])) && (k + 1 == text.size() || !joins(text[k + 1])))
      return true;
  return false;
}

/// True if friction is more than a quantity: "2 kg/s*T" would be one, of teslas.
bool is_formula(Item const& item) {
  if (!item.is(Item::Kind::text)) return false;
  if (has_word(item.text, 'r') || has_word(item.text, 'T')) return true;
  try {
    parse_quantity(item.text);
    return false;
  } catch (Error const&) {
    return item.text.find_first_of("+-*/^(") != std::string::npos;
  }
}

/// The places of friction formulas; null: there is none.
struct FrictionTexts {
  Item const *weight = nullptr, *friction = nullptr;
  FrictionFormulas formulas = {};

  bool any() const { return weight || friction; }
};

/// Reads weight, parameters, and friction if it is a formula, and removes them from the keys.
FrictionTexts read_friction_texts(Section& section, OptionTable& keys, Reading& reading) {
  FrictionTexts texts;
  texts.formulas.units = reading.base_known ? reading.context.units : UnitSystem::reduced();
  if (Item const* item = section.item("friction"); item && is_formula(*item)) {
    texts.friction = section.find("friction");
    section.explain(*keys.find("friction"));
    if (auto const text = read_text(*item, "friction", reading.context)) texts.formulas.friction = *text;
    std::vector<OptionKey> others;
    for (auto const& key : keys.keys())
      if (key != "friction") others.push_back({key});
    keys = keys.only(others);
  }
  texts.weight = section.find("weight");
  if (texts.weight) {
    if (auto const text = read_text(*texts.weight, "weight", reading.context)) texts.formulas.weight = *text;
    section.refuse("exponent", "'weight' also defines chi; leave one out");
  }
  reading.refuse_neighbour_fields(texts.formulas.friction, "friction", section.place("friction"));
  if (texts.any())
    texts.formulas.parameters = read_formula_parameters(section, reading);
  else
    section.refuse("parameters", "formulas use them, a 'weight' or a friction, and there is none");
  return texts;
}

/// The range from half of the lowest internal temperature to twice the highest.
void find_temperatures(FrictionFormulas& formulas, std::initializer_list<ReadEnsemble const*> ensembles) {
  double lowest = HUGE_VAL, highest = 0;
  for (ReadEnsemble const* one : ensembles) {
    if (!one || !one->particles || !one->state) continue;
    AnyEnsemble const& particles = *one->particles;
    int const energy = particles.field("internal_energy").offset;
    for (std::size_t i = 0; i < particles.size(); ++i) {
      double const own = one->state->temperature(particles.row(i)[energy]);
      if (own > 0) lowest = std::min(lowest, own), highest = std::max(highest, own);
    }
  }
  if (highest > 0) formulas.temperatures = {0.5 * lowest, 2 * highest};
}

/// Adds formulas to the law; reports mistakes at their places.
void apply(FrictionTexts& texts, DissipationLaw& law, ReadEnsemble const* a, ReadEnsemble const* b, Section& section,
           Reading& reading) {
  find_temperatures(texts.formulas, {a, b});
  try {
    law = with_formulas(law, texts.formulas);
  } catch (FormulaPartError const& error) {
    bool const of_weight = error.part == "weight" || !texts.friction;
    refuse_formula(section, error, *(of_weight ? texts.weight : texts.friction), of_weight ? "weight" : "friction",
                   reading);
  } catch (Error const& error) {  // too long for a program
    reading.mistake((texts.weight ? texts.weight : texts.friction)->place, error.what());
  }
}

/// True if it can act between these; otherwise adds a mistake.
bool can_act(DissipationLaw const& dissipation, ReadEnsemble const& a, ReadEnsemble const& b, Section& section,
             Dissipations& all) {
  Reading& reading = all.reading;
  char const* key = section.has("on") ? "on" : "between";
  Place const whom = section.place(key);
  if (!supports(a, whom, key, reading) || (&a != &b && !supports(b, whom, key, reading)) || !reading.result->pairs)
    return false;
  if (taken(all.dissipations, &a, &b, whom, "dpd", reading)) return false;
  for (int axis = 0; axis < reading.dimension; ++axis)
    if (double const most = 0.5 * reading.box->length(axis); reading.box->periodic(axis) && dissipation.range > most) {
      reading.mistake(section.place("range"),
                      fmt::format("range: {} is longer than half of the periodic axis {}, {}: a particle would "
                                  "meet another one twice",
                                  dissipation.range, "xyz"[axis], most));
      return false;
    }
  if (dissipation.convention == Convention::fixed_temperature) return true;
  for (ReadEnsemble const* one : {&a, &b})
    if (!has_temperatures(*one, section.place("convention"), section.item("convention")->text, reading)) return false;
  return true;
}

void add_pairs(DissipationLaw const& dissipation, ReadEnsemble& a, ReadEnsemble& b, Dissipations& all) {
  Reading& reading = all.reading;
  if (!all.pairs) {
    auto pairs = std::make_unique<PairDissipation>(*reading.result->pairs, reading.boltzmann_constant());
    pairs->method(all.together.method);
    pairs->corrector(all.together.corrector);
    pairs->metropolis(all.together.metropolis);
    all.pairs = pairs.get();
    reading.result->dissipations.push_back(std::move(pairs));
  }
  for (ReadEnsemble const* one : {&a, &b})
    if (one->state && (one == &a || &a != &b)) all.pairs->state(*one->particles, *one->state);
  if (&a == &b)
    all.pairs->internal(*a.particles, dissipation);
  else
    all.pairs->between(*a.particles, *b.particles, dissipation);
}

void read_pairs(Section& section, Item const& table, Dissipations& all) {
  Reading& reading = all.reading;
  std::size_t const before = reading.context.mistakes.count();
  auto const pair = read_pair(section, reading);
  ReadEnsemble *const a = pair.first, *const b = pair.second;
  DissipationOptions options;
  OptionTable keys = dissipation_options();
  auto texts = read_friction_texts(section, keys, reading);
  read_options(section, keys, &options, {.dimension = reading.dimension});
  DissipationLaw& dissipation = options.dissipation;
  if (section.has("convention") && section.item("convention")->text == to_string(dissipation.convention))
    check_convention(section, dissipation, reading);
  check_method(section, options, all);
  section.finish();
  if (texts.any() && reading.context.mistakes.count() == before) apply(texts, dissipation, a, b, section, reading);
  if (!all.first_dpd) {
    all.first_dpd = table.place;
    all.together = options;
  }
  if (all.together.metropolis &&
      (dissipation.convention == Convention::fixed_temperature || dissipation.convention == Convention::deterministic))
    reading.mistake(section.place("convention"),
                    fmt::format("convention: 'metropolis' is for friction with noise and internal energies, not for "
                                "\"{}\"",
                                to_string(dissipation.convention)));
  if (reading.result->scheme<MeshScheme>())
    return reading.mistake(
        table.place,
        "dissipation acts between near particles, for which a scenario with a [mesh] has no neighbour lists");
  if (reading.context.mistakes.count() != before || !a || !b) return;
  if (can_act(dissipation, *a, *b, section, all))
    catch_errors(reading, table.place, [&] { add_pairs(dissipation, *a, *b, all); });
}

struct ReadBath {
  BathOptions options;
  std::function<double(double)> temperature;  ///< function of time; null: constant, as in the options
};

/// A heat bath from the keys of its kind; nothing, and mistakes, if they are invalid.
std::optional<ReadBath> read_bath(Section& section, OptionTable const& keys, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  ReadBath bath;
  OptionTable known = keys;
  auto const formulas = read_time_formulas(section, known, {"temperature"}, reading);
  if (!formulas.empty()) bath.temperature = formulas.front().value;
  read_options(section, known, &bath.options, {.dimension = reading.dimension});
  if (bath.options.low.has_value() != bath.options.high.has_value())
    reading.mistake(section.place(bath.options.low ? "low" : "high"),
                    fmt::format("{}: a block needs both 'low' and 'high'; leave both out for everywhere",
                                bath.options.low ? "low" : "high"));
  if (reading.context.mistakes.count() != before || !reading.base_known) return std::nullopt;
  if (bath.temperature) bath.options.temperature = bath.temperature(0);
  return bath;
}

template <class Bath>
std::unique_ptr<Bath> make_bath(ReadBath const& read, Reading const& reading) {
  BathOptions const& options = read.options;
  double const k = reading.boltzmann_constant();
  std::unique_ptr<Bath> bath;
  if constexpr (std::is_same_v<Bath, NoseHooverChain>)
    bath = std::make_unique<Bath>(options.temperature, options.rate, k, options.chain);
  else
    bath = std::make_unique<Bath>(options.temperature, options.rate, k);
  if (read.temperature) bath->temperature(read.temperature);
  if (options.low) bath->within({*options.low, *options.high});
  return bath;
}

std::unique_ptr<HeatBath> make_bath(std::string const& kind, ReadBath const& read, Reading const& reading) {
  if (kind == "velocity-rescaling") return make_bath<VelocityRescaling>(read, reading);
  if (kind == "nose-hoover") return make_bath<NoseHooverChain>(read, reading);
  return make_bath<LangevinBath>(read, reading);
}

void read_heat_bath(Section& section, DissipationKind const& kind, Dissipations& all) {
  Reading& reading = all.reading;
  std::size_t const before = reading.context.mistakes.count();
  section.explain_said(dissipation_pair_options());
  Item const* on = section.need("on", "on = \"atoms\"");
  auto const ensembles = named_ensembles(on, "on", reading);
  auto const read = read_bath(section, kind.options, reading);
  section.finish();
  if (reading.context.mistakes.count() != before || !read) return;
  for (auto const& [ensemble, place] : ensembles) {
    if (!supports(*ensemble, place, "on", reading, true)) return;
    if (!read->options.low && taken(all.baths, ensemble, ensemble, place, kind.name, reading)) return;
  }
  catch_errors(reading, on->place, [&] {
    auto bath = make_bath(kind.name, *read, reading);
    for (auto const& [ensemble, place] : ensembles) bath->on(*ensemble->particles);
    reading.settable.push_back(settable_number(fmt::format("dissipation.{}.temperature", all.number),
                                               dimensions::temperature, kind.options.find("temperature")->kind.range,
                                               [bath = bath.get()](Simulation&, double t) { bath->temperature(t); }));
    reading.result->dissipations.push_back(std::move(bath));
  });
}

void read_table(Item const& table, Dissipations& all) {
  Reading& reading = all.reading;
  Section section(table, "[[dissipation]]", reading.context);
  Item const* word = section.need("kind", "kind = \"dpd\"");
  std::vector<std::string> kinds;
  for (auto const& one : dissipation_kinds()) kinds.push_back(one.name);
  auto const kind = word ? read_word(*word, "dissipation", kinds, reading.context) : std::nullopt;
  if (!kind) return;
  section.rename(fmt::format("[[dissipation]] '{}'", *kind));
  for (auto const& one : dissipation_kinds()) {
    if (one.name != *kind) continue;
    section.explain_word("kind", one.doc);
    if (*kind == "dpd")
      read_pairs(section, table, all);
    else
      read_heat_bath(section, one, all);
  }
}

/// Default of `on`: the particles moved by forces with leap-frog.
std::vector<ReadEnsemble const*> to_be_equilibrated(Item const* on, Reading& reading) {
  std::vector<ReadEnsemble const*> chosen;
  if (!on) {
    for (auto const& ensemble : reading.ensembles)
      if (ensemble.particles && !ensemble.smooth() && ensemble.integrator && carries_momentum(*ensemble.particles) &&
          ensemble.integrator->method() == Method::leap_frog)
        chosen.push_back(&ensemble);
    return chosen;
  }
  for (auto const& [ensemble, place] : named_ensembles(on, "on", reading))
    if (supports(*ensemble, place, "on", reading, true) &&
        std::find(chosen.begin(), chosen.end(), ensemble) == chosen.end())
      chosen.push_back(ensemble);
  return chosen;
}

void read_equilibration(Item const& table, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  Section section(table, "[equilibrate]", reading.context);
  section.explain_said(equilibration_options());
  Item const* on = section.find("on");
  auto const read = read_bath(section, equilibration_bath_options(), reading);
  auto const time = section.need_quantity(
      "time", dimensions::time, reading.context.units.is_reduced() ? "time = 10" : "time = \"2 ps\"", not_negative);
  section.finish();
  auto const chosen = to_be_equilibrated(on, reading);
  if (reading.context.mistakes.count() != before || !read || !time || !reading.run.step) return;
  // A time that equals a number of steps, up to rounding, gives this number.
  double const steps = std::ceil(*time / *reading.run.step * (1 - 1e-12));
  if (steps > max_steps)
    return reading.mistake(section.place("time"), fmt::format("time: it would need {:.3g} steps", steps));
  bool const loaded = std::all_of(reading.ensembles.begin(), reading.ensembles.end(),
                                  [](ReadEnsemble const& ensemble) { return ensemble.particles != nullptr; });
  if (!loaded) return;
  if (chosen.empty())
    return reading.mistake(
        table.place,
        fmt::format("[equilibrate]: there is no ensemble of particles with mass and velocity whose integrator is "
                    "\"leap-frog\"{}",
                    reading.smooth.wanted ? " (smooth particles have the viscosity and the conductivity of their "
                                            "material, and no other friction)"
                                          : ""));
  catch_errors(reading, table.place, [&] {
    auto bath = make_bath<LangevinBath>(*read, reading);
    for (ReadEnsemble const* ensemble : chosen) bath->on(*ensemble->particles);
    reading.equilibration = {std::move(bath), static_cast<std::uint64_t>(steps)};
  });
}

}  // namespace

void read_dissipations(Section& document, Reading& reading) {
  Dissipations all{reading, nullptr, {}, {}, 0, {}, {}};
  for (Item const* table : find_tables(document, "dissipation")) {
    read_table(*table, all);
    ++all.number;
  }
  if (Item const* table = find_table(document, "equilibrate")) read_equilibration(*table, reading);
}

void add_dissipations(Reading const& reading) {
  Simulation& simulation = *reading.result->simulation;
  for (auto const& dissipation : reading.result->dissipations) simulation.add(*dissipation);
  if (reading.equilibration.bath) simulation.equilibrate(reading.equilibration.bath, reading.equilibration.steps);
}

}  // namespace boltzmann
