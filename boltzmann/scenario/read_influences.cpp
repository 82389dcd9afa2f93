// Reads [[influences]]: laws and the ensembles on which they act.
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/laws/formula_law.hpp>
#include <boltzmann/scenario/among.hpp>
#include <boltzmann/scenario/field_formulas.hpp>
#include <boltzmann/scenario/laws.hpp>
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/scenario/tables.hpp>
#include <boltzmann/schemes/mesh/mesh_scheme.hpp>
#include <boltzmann/schemes/pair/tail_correction.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

namespace boltzmann {
namespace {

/// [first, last, interval] or [first, last].
std::vector<Connection> read_connections(Item const& item, AnyEnsemble const* ensemble, Reading& reading) {
  std::vector<Connection> connections;
  auto const wrong = [&](Item const& where) {
    reading.mistake(where.place, fmt::format("connect: [[first, last, interval]] is needed, e.g. [[0, 99, 1]], not {}",
                                             describe(where)));
  };
  if (!item.is(Item::Kind::array)) {
    wrong(item);
    return {};
  }
  for (auto const& triple : item.elements) {
    if (!triple.is(Item::Kind::array) || triple.elements.size() < 2 || triple.elements.size() > 3) {
      wrong(triple);
      return {};
    }
    std::array<std::size_t, 3> numbers{0, 0, 1};
    bool good = true;
    for (std::size_t k = 0; k < triple.elements.size(); ++k) {
      auto const n = read_integer(triple.elements[k], "connect", k == 2 ? 1 : 0, 4'000'000'000, reading.context);
      good = good && n;
      if (n) numbers[k] = static_cast<std::size_t>(*n);
    }
    if (!good) continue;
    if (ensemble && numbers[1] >= ensemble->size()) {
      reading.mistake(triple.place, fmt::format("connect: there is no particle {}; '{}' has {}, numbered from 0 to {}",
                                                numbers[1], ensemble->name(), ensemble->size(), ensemble->size() - 1));
    } else if (numbers[0] > numbers[1]) {
      reading.mistake(triple.place, fmt::format("connect: it runs from {} back to {}; the first number must not be "
                                                "above the last",
                                                numbers[0], numbers[1]));
    } else {
      connections.push_back({numbers[0], numbers[1], numbers[2]});
    }
  }
  if (ensemble)
    catch_errors(reading, item.place, [&] {
      try {
        connected_pairs(connections, ensemble->size());
      } catch (Error const& error) {
        throw Error(fmt::format("connect: {}", error.what()));
      }
    });
  return connections;
}

/// Adds the influence of one table to the scheme: its law, ensembles and parameters.
class InfluenceReader {
 public:
  /// Reads table `number`. `one_of_several`: expanded from a table with `among`, which has already been read.
  InfluenceReader(Item const& table, std::size_t number, Reading& reading, bool one_of_several)
      : reading_(reading),
        number_(number),
        before_(reading.context.mistakes.count()),
        section_(table, "[[influences]]", reading.context) {
    for (char const* key : {"among", "mixing"}) one_of_several ? section_.mark_used(key) : section_.allow(key);
    if (!one_of_several && section_.has("mixing"))
      reading.mistake(section_.place("mixing"), "mixing: it belongs to 'among', the names of several ensembles");
  }

  void read() {
    typed_item_ = section_.has("influence") ? section_.find("influence") : nullptr;
    if (section_.has("energy")) typed_item_ = section_.find("energy");
    if (typed_item_) return read_typed();
    for (char const* key : {"energy", "influence", "parameters", "from_outside", "changes", "angles", "dihedrals"}) {
      if (section_.has(key))
        reading_.mistake(section_.place(key),
                         fmt::format("{}: it belongs to a formula law, one with an energy or an influence", key));
      section_.allow(key);
    }
    read_law();
    on_ = section_.find("on");
    if (!external()) by_ = section_.find("by"), between_ = section_.find("between");
    read_ensembles();
    read_plain_keys();
    read_every();
    if (!law_ || refused_with_smooth() || refused_with_bodies()) return;
    auto const parameters = read_parameters(section_, fmt::format("law '{}'", law_->name), law_->parameters, reading_);
    if (external())
      only_ = read_particles(section_, a_ ? a_->particles : nullptr, reading_);
    else
      read_pairs();
    check_end();
    check_tail();
    section_.finish();
    bool const there =
        a_ && b_ && a_->particles && b_->particles && (a_->smooth() ? smooth_ != nullptr : pairs_ != nullptr);
    if (reading_.context.mistakes.count() == before_ && there) install(*parameters);
  }

 private:
  bool external() const { return typed_item_ ? options_.from_outside : law_ && law_->kind == LawKind::external; }

  /// Reads plain numbers, words and flags.
  void read_plain_keys() {
    std::vector<OptionKey> keys{{"every"}, {"tail"}};
    if (!external())
      for (char const* key : {"cutoff", "precision", "bonded_factors", "at_cutoff", "switch_from"})
        keys.push_back({key});
    read_only(std::move(keys));
    typed_.at_cutoff = options_.at_cutoff;
    typed_.switch_from = options_.switch_from.value_or(0);
  }
  void read_only(std::vector<OptionKey> keys) {
    read_options(section_, influence_options().only(keys), &options_, {.dimension = reading_.dimension});
  }

  // ---- A typed law ----

  void read_typed() {
    bool const by_energy = section_.has("energy");
    section_.rename(by_energy ? "[[influences]] with an energy" : "[[influences]] with an influence");
    section_.explain_said(influence_options());
    law_place_ = typed_item_->place;
    if (by_energy && section_.has("influence"))
      reading_.mistake(section_.place("influence"), "influence: there is an energy already, which gives it");
    if (section_.has("law"))
      reading_.mistake(section_.place("law"), fmt::format("law: there is {} already; leave one out",
                                                          by_energy ? "an energy" : "an influence"));
    section_.allow("law"), section_.allow("influence");
    read_only({{"from_outside"}});
    bool const from_outside = options_.from_outside;
    on_ = section_.find("on");
    if (!from_outside) by_ = section_.find("by"), between_ = section_.find("between");
    typed_.gives = by_energy ? FormulaLaw::Gives::energy : FormulaLaw::Gives::influence;
    typed_.units = reading_.context.units;
    if (by_energy)
      section_.refuse("changes",
                      "an energy moves particles; what changes a field is an influence, which gives its rate");
    else
      read_only({{"changes"}}), typed_.changes = options_.changes;
    auto const text = read_text(*typed_item_, by_energy ? "energy" : "influence", reading_.context);
    if (text) typed_.text = *text;
    typed_.parameters = read_formula_parameters(section_, reading_);
    Item const* where = from_outside ? section_.item("where") : nullptr;
    if (!from_outside || (where && where->is(Item::Kind::table))) typed_.where = read_formula_parts(section_, reading_);
    reading_.refuse_neighbour_fields(typed_.text, by_energy ? "energy" : "influence", law_place_);
    for (auto const& part : typed_.where)
      reading_.refuse_neighbour_fields(part.text, "where." + part.name, section_.place("where"));
    read_ensembles();
    read_plain_keys();
    read_every();
    check_end();
    read_tuples();
    check_tail();
    if (!from_outside)
      read_pairs();
    else if (!where || !where->is(Item::Kind::table))
      only_ = read_particles(section_, a_ ? a_->particles : nullptr, reading_);
    section_.finish();
    check_changes(a_);
    if (between_ && a_ != b_) check_changes(b_);
    bool const moves = typed_.changes.empty();
    if (moves && ((a_ && a_->smooth()) || (b_ && b_->smooth())))
      reading_.mistake(law_place_,
                       "formula laws don't act on smooth particles yet, which are moved by their 'material'");
    bool const there = a_ && b_ && a_->particles && b_->particles && pairs_;
    if (reading_.context.mistakes.count() != before_ || !there) return;
    double const reach = from_outside || connect_ || tuples() ? no_cutoff : reach_of_pairs();
    if (reading_.context.mistakes.count() != before_ || std::isnan(reach)) return;
    note_jump(reach);
    add_typed(reach, by_energy ? "energy" : "influence");
  }

  void add_typed(double reach, char const* key) {
    AnyEnsemble &a = *a_->particles, &b = *b_->particles;
    bool const from_outside = options_.from_outside;
    try {
      BondedFactors const bonded(*pairs_, *a_, options_.bonded_factors);
      if (angles_)
        molecule_scheme(reading_).angles(a, angle_members_, typed_);
      else if (dihedrals_)
        molecule_scheme(reading_).dihedrals(a, dihedral_members_, typed_);
      else if (from_outside)
        pairs_->external(a, typed_, only_ ? &*only_ : nullptr);
      else if (connect_)
        pairs_->connect(a, connections_, typed_);
      else if (by_)
        pairs_->one_way(a, b, typed_, reach);
      else if (between_)
        pairs_->between(a, b, typed_, reach);
      else
        pairs_->internal(a, typed_, reach);
      if (typed_.changes.empty() && !from_outside && !tuples())
        reading_.result->typed_laws.push_back({fmt::format("influences.{}.{}", number_, key), typed_, &a, &b, reach});
      add_tail(typed_, reach);
    } catch (FormulaPartError const& error) {
      refuse_formula(section_, error, *typed_item_, key, reading_);
    } catch (Error const& error) {
      reading_.mistake(law_place_, error.what());
    }
  }
  bool tuples() const { return angles_ || dihedrals_; }
  /// angles, dihedrals: the ensemble, and keys that have no effect there.
  void read_tuples() {
    angles_ = section_.find("angles");
    dihedrals_ = section_.find("dihedrals");
    if (!tuples()) return;
    std::string const key = angles_ ? "angles" : "dihedrals";
    if (angles_ && dihedrals_)
      reading_.mistake(dihedrals_->place, "dihedrals: there are angles already; write two tables of [[influences]]");
    if (typed_.gives != FormulaLaw::Gives::energy)
      reading_.mistake(section_.place(key), fmt::format("{}: the law is an energy, not an influence", key));
    if (between_ || by_)
      reading_.mistake(section_.place(key), fmt::format("{}: they are within one ensemble; write 'on'", key));
    for (char const* other :
         {"cutoff", "connect", "at_cutoff", "switch_from", "tail", "precision", "bonded_factors", "from_outside"})
      if (section_.has(other))
        reading_.mistake(section_.place(other), fmt::format("{}: it means nothing beside {}", other, key));
    if (angles_) angle_members_ = read_angles(*angles_, a_, reading_);
    if (dihedrals_) dihedral_members_ = read_dihedrals(*dihedrals_, a_, reading_);
  }
  /// Adds a mistake if an ensemble has no such field, or one that is constant.
  void check_changes(ReadEnsemble const* one) {
    if (typed_.changes.empty() || !one || !one->particles) return;
    Item const& item = *section_.item("changes");
    catch_errors(reading_, item.place, [&] {
      AnyEnsemble const& particles = *one->particles;
      if (particles.number_driven(particles.field(typed_.changes)) >= 0) return;
      std::vector<std::string> names;
      for (auto const& field : particles.fields())
        if (particles.number_driven(field) >= 0) names.push_back(field.name);
      throw Error(
          fmt::format("changes: {} of class {} has no rate{}; its [[classes]] gives one, rate.{} = 0 if nothing "
                      "else changes it",
                      typed_.changes, particles.class_name(),
                      names.empty() ? "" : fmt::format(", as {} has", join(names)), typed_.changes));
    });
  }

  /// at_cutoff, switch_from.
  void check_end() {
    if (external() || section_.has("connect"))
      section_.refuse("at_cutoff", external() ? "an external law has no cut-off" : "connections have no cut-off");
    Item const* const item = section_.item("at_cutoff");
    bool const wrong = item && options_.at_cutoff == FormulaLaw::AtCutoff::cut && item->text != "cut";
    if (options_.at_cutoff != FormulaLaw::AtCutoff::switched && !wrong)
      section_.refuse("switch_from", "it belongs to at_cutoff = \"switch\"");
  }
  /// Energy and pressure of pairs beyond the cut-off.
  void check_tail() {
    if (!options_.tail) return;
    Place const place = section_.place("tail");
    if (external() || section_.has("connect"))
      reading_.mistake(place,
                       fmt::format("tail: {} no cut-off", external() ? "an external law has" : "connections have"));
    else if (by_)
      reading_.mistake(place, "tail: it is of pairs that act on each other; write 'on' alone, or 'between'");
    else if (options_.at_cutoff != FormulaLaw::AtCutoff::cut)
      reading_.mistake(place, "tail: a law that is shifted or switched ends at its cut-off; leave out one of the two");
    else if (reading_.run.shifted)
      reading_.mistake(
          place, "tail: energies of pairs are counted from the cut-off; with a tail write shifted = false in [run]");
  }
  void add_tail(FormulaLaw const& law, double reach) {
    if (!options_.tail) return;
    catch_errors(reading_, section_.place("tail"), [&] {
      auto* tails = reading_.result->scheme<TailCorrection>();
      if (!tails) {
        auto made = std::make_unique<TailCorrection>(*reading_.box);
        tails = made.get();
        reading_.result->schemes.push_back(std::move(made));
      }
      tails->between(*a_->particles, *b_->particles, law, reach);
    });
  }

  /// Records energies that jump when pairs cross the cut-off, because barostats need this.
  void note_jump(double reach) {
    if (std::isfinite(reach) && !reading_.run.shifted && !options_.tail &&
        typed_.at_cutoff == FormulaLaw::AtCutoff::cut && !reading_.jump)
      reading_.jump = law_place_;
  }

  /// A shipped law as a formula. Throws Error if that is not possible.
  FormulaLaw typed_twin(ParameterValues const& parameters) const {
    std::string const text(law_->typed.in[reading_.dimension - 1]);
    if (text.empty())
      throw Error(fmt::format("law '{}' has no formula that could be ended at the cut-off, or integrated beyond it",
                              law_->name));
    FormulaLaw twin = typed_;
    twin.gives = law_->has_energy ? FormulaLaw::Gives::energy : FormulaLaw::Gives::influence;
    twin.text = text;
    for (auto const& [name, value] : parameters) twin.parameters.push_back({name, value.front(), dimensions::none});
    return twin;
  }
  /// The same law, smoothly truncated at the cut-off; adds a mistake if that is not possible.
  void install_ended(ParameterValues const& parameters, double reach) {
    AnyEnsemble &a = *a_->particles, &b = *b_->particles;
    if (single()) throw Error("at_cutoff: in single precision laws have no cut-off");
    FormulaLaw const law = typed_twin(parameters);
    if (by_)
      pairs_->one_way(a, b, law, reach);
    else if (between_)
      pairs_->between(a, b, law, reach);
    else
      pairs_->internal(a, law, reach);
  }

  std::string called() const { return typed_item_ ? "the formula law" : fmt::format("law '{}'", law_->name); }

  // ---- A shipped law ----

  void read_law() {
    std::vector<std::string> names;
    for (auto const& law : scenario_laws()) names.emplace_back(law.name);
    Item const* item = section_.need(
        "law", "law = \"lennard-jones\", or energy = \"exp(-r)/r\" or influence = \"...\" of a formula law");
    if (!item) return refuse_other_words();
    if (item->is(Item::Kind::text) && !find_law(item->text) && hint_for(item->text, names).empty())
      return reading_.mistake(item->place,
                              fmt::format("unknown law '{}'; for others write a formula: energy = \"exp(-r)/r\", or "
                                          "influence = \"...\" (bzm new --law){}",
                                          quoted(item->text), choices_with("", names, "there are", "bzm list laws")));
    auto const name = read_word(*item, "law", names, reading_.context);
    if (!name) return;
    law_ = find_law(*name);
    law_place_ = item->place;
    section_.explain_word("law", law_->doc);
    section_.explain_said(influence_options());
    section_.rename(fmt::format("[[influences]] '{}'", *name));
  }
  /// "force", "potential": other names of the keys for a formula.
  void refuse_other_words() {
    std::vector<std::string> const keys{"law", "energy", "influence"};
    for (auto const& [key, place, item] : section_.table().entries)
      if (auto const near = did_you_mean(key, keys); !influence_options().find(key) && !near.empty())
        reading_.mistake(place, fmt::format("unknown key '{}' in [[influences]]{}", key, near));
  }
  bool refused_with_smooth() {
    if (external() || !((a_ && a_->smooth()) || (b_ && b_->smooth()))) return false;
    reading_.mistake(law_place_, fmt::format("law '{}' acts between pairs of particles; smooth particles act on each "
                                             "other by what they are made of, their 'material'",
                                             law_->name));
    return true;
  }

  void read_ensembles() {
    if (between_ && (on_ || by_))
      return reading_.mistake(between_->place,
                              "[[influences]] needs 'on', or 'on' and 'by', or 'between', not more of them");
    if (between_) {
      std::tie(a_, b_) = two_ensembles(*between_, reading_);
    } else if (on_) {
      a_ = b_ = reading_.ensemble(*on_, "on");
      if (!by_) return;
      b_ = reading_.ensemble(*by_, "by");
      if (a_ && a_ == b_) refuse_twice(*by_, "by", reading_), a_ = nullptr;
    } else if (by_) {
      reading_.mistake(by_->place, "by: it names the ensemble that acts; 'on', the ensemble that feels it, is missing");
    } else if (section_.has("one_way")) {
      return;  // as before, which section_.finish() reports
    } else if (!external()) {
      reading_.mistake(section_.place(),
                       "[[influences]] does not name its ensembles: add on = \"atoms\", between = [\"a\", \"b\"], on = "
                       "\"a\" with by = \"b\", or among = [\"a\", \"b\"]");
    } else if (!section_.has("between") && !section_.has("by")) {
      reading_.mistake(section_.place(), fmt::format("{} is external and needs 'on', e.g. on = \"atoms\"", called()));
    }
  }

  /// Slow laws have a scheme of their own, one per number of steps.
  void read_every() {
    std::int64_t const steps = options_.every;
    if (steps == 1 || !pairs_ || !reading_.box) return;
    Place const place = section_.place("every");
    if (a_ && a_->smooth())
      return reading_.mistake(place, "every: laws on smooth particles are calculated in each step; leave it out");
    if (reading_.result->scheme<MeshScheme>())
      return reading_.mistake(
          place,
          "every: a scenario with a [mesh] has all its pair laws in that scheme, which is calculated "
          "in each step; leave it out");
    for (auto const& [slow, of_slow] : reading_.slow)
      if (of_slow == steps)
        if (auto* pairs = dynamic_cast<PairScheme*>(slow)) {
          pairs_ = pairs;
          return;
        }
    auto own = std::make_unique<PairScheme>(*reading_.box, reading_.run.cutoff.value_or(no_cutoff));
    own->threads(reading_.run.threads);
    if (reading_.run.skin) own->skin(*reading_.run.skin);
    pairs_ = own.get();
    reading_.slow.emplace_back(pairs_, steps);
    reading_.result->schemes.push_back(std::move(own));
  }

  void read_pairs() {
    connect_ = section_.find("connect");
    check_bonded_factors();
    if (!connect_) return;
    if (single()) reading_.mistake(section_.place("precision"), "precision: connections have full precision only");
    if (connect_->is(Item::Kind::text)) {
      if (connects_bonds(*connect_, a_, reading_) && a_) connections_ = connections_of(a_->molecules.bonds);
    } else {
      connections_ = read_connections(*connect_, a_ ? a_->particles : nullptr, reading_);
    }
    if (between_ || by_)
      reading_.mistake(connect_->place,
                       "connect: connections are within one ensemble; put the particles into one and write "
                       "'on'. A pivot that stays where it is: class Tethered with the law 'tether'");
    if (section_.has("cutoff")) reading_.mistake(section_.place("cutoff"), "cutoff: connections have none");
  }

  bool single() const { return options_.precision == "single"; }

  void check_bonded_factors() {
    if (!section_.has("bonded_factors")) return;
    auto const wrong = [&](char const* what) { section_.mistake("bonded_factors", what); };
    if (connect_) wrong("connections are fixed pairs already; leave it out");
    if (between_ || by_) wrong("particles of two ensembles are not bonded; write 'on'");
    if (a_ && a_->particles && a_->molecules.bonds.empty())
      wrong("the ensemble has no bonds; its [[ensembles]] gives them, bonds = \"chain\" or [[0, 1], [0, 2]]");
  }
  /// Bonded factors of the laws that are installed while this object exists.
  struct BondedFactors {
    BondedFactors(PairScheme& scheme, ReadEnsemble const& of, std::vector<double> const& factors)
        : scheme(scheme), of(of), given(!factors.empty()) {
      if (given) scheme.bonded_factors(*of.particles, of.molecules.bonds, factors);
    }
    ~BondedFactors() {
      if (given) scheme.bonded_factors(*of.particles, {}, {});
    }
    BondedFactors(BondedFactors const&) = delete;
    BondedFactors& operator=(BondedFactors const&) = delete;

    PairScheme& scheme;
    ReadEnsemble const& of;
    bool given;
  };

  void install(ParameterValues const& parameters) {
    AnyEnsemble &a = *a_->particles, &b = *b_->particles;
    bool const smooth = a_->smooth();
    if (smooth && (section_.has("particles") || section_.has("where")))
      return reading_.mistake(section_.place(section_.has("particles") ? "particles" : "where"),
                              fmt::format("law '{}' acts on all smooth particles of an ensemble; put some of them into "
                                          "one of their own",
                                          law_->name));
    double const reach = smooth || external() || connect_ ? no_cutoff : reach_of_pairs();
    if (reading_.context.mistakes.count() != before_ || std::isnan(reach)) return;
    note_jump(reach);
    catch_errors(reading_, law_place_, [&] {
      std::optional<BondedFactors> bonded;
      if (!options_.bonded_factors.empty()) bonded.emplace(*pairs_, *a_, options_.bonded_factors);
      if (smooth)
        install_external(*smooth_, *law_, parameters, a);
      else if (external())
        install_settable(parameters, a);
      else if (connect_)
        install_connections(*pairs_, *law_, parameters, a, connections_);
      else if (typed_.at_cutoff != FormulaLaw::AtCutoff::cut)
        install_ended(parameters, reach);
      else
        install_pairs(*pairs_, *law_, parameters,
                      between_ ? LawUse::between
                      : by_    ? LawUse::one_way
                               : LawUse::internal,
                      a, b, reach, single());
      if (options_.tail) add_tail(typed_twin(parameters), reach);
    });
    act_on_bodies(parameters);
  }

  /// An external influence whose parameters events may set.
  void install_settable(ParameterValues const& parameters, AnyEnsemble& particles) {
    install_external(*pairs_, *law_, parameters, particles, only_ ? &*only_ : nullptr);
    auto const values = std::make_shared<ParameterValues>(parameters);
    auto const change = [scheme = pairs_, number = pairs_->externals() - 1, law = law_, values](
                            std::string_view name, std::vector<double> const& value) {
      for (auto& one : *values)
        if (one.first == name) one.second = value;
      change_external(*scheme, number, *law, *values);
    };
    for (auto const& parameter : law_->parameters) {
      std::string const name(parameter.name), path = fmt::format("influences.{}.{}", number_, name);
      Dimension const dimension = parameter.dimension.in(reading_.dimension);
      if (!parameter.vector) {
        reading_.settable.push_back(settable_number(
            path, dimension, parameter.range, [change, name](Simulation&, double value) { change(name, {value}); }));
        continue;
      }
      bool const one = parameter.axial && reading_.dimension < 3;
      reading_.settable.push_back(
          {path, [=](Item const& item, Reading& reading) -> std::function<void(Simulation&)> {
             auto const value =
                 one ? std::nullopt : read_vector(item, path, reading.dimension, dimension, reading.context);
             auto const alone = one ? read_quantity(item, path, dimension, reading.context) : std::nullopt;
             if (!value && !alone) return nullptr;
             auto const numbers = value ? *value : std::vector<double>{*alone};
             return [change, name, numbers](Simulation&) { change(name, numbers); };
           }});
    }
  }

  /// Flows also act on bodies: each ensemble of vortices, and each external law, once.
  void act_on_bodies(ParameterValues const& parameters) {
    ParticleClass const* target = find_class(law_->target);
    if (!reading_.bodies || connect_ || only_ || a_->smooth() || !target || target->classical) return;
    auto const act = [&](std::string const& what, auto const& install) {
      if (!reading_.acts_on_bodies.insert(what).second) return;
      for (auto* body : reading_.bodies->bodies()) catch_errors(reading_, law_place_, [&] { install(*body); });
    };
    if (external()) {
      std::string what = fmt::format("law {}", law_->name);
      for (auto const& parameter : parameters)
        for (double const number : parameter.second) what += fmt::format(" {}", number);
      return act(what, [&](AnyEnsemble& body) { install_external(*pairs_, *law_, parameters, body, nullptr); });
    }
    if (law_->target != "Tracer") return;  // it moves no particle, as an exchange of vorticity
    for (auto* source : {between_ ? a_ : nullptr, b_})
      if (source && source->particles->find_field("vorticity"))
        act(source->name, [&](AnyEnsemble& body) {
          install_pairs(*pairs_, *law_, parameters, LawUse::one_way, body, *source->particles, no_cutoff);
        });
  }
  bool refused_with_bodies() {
    for (auto const* one : {a_, b_})
      if (one && reading_.bodies && one->kind == &body_class()) {
        reading_.mistake(
            law_place_, fmt::format("'{}' is a body: all vortices and streams that act on others act on it, too; leave "
                                    "this influence out",
                                    one->name));
        return true;
      }
    return false;
  }

  /// The cut-off; adds a mistake if periodic axes are too short for it. NaN: unknown.
  double reach_of_pairs() {
    auto const& own = options_.cutoff;
    if (!own && !reading_.run.cutoff_known) return std::numeric_limits<double>::quiet_NaN();
    double const reach = own ? *own : reading_.run.cutoff.value_or(no_cutoff);
    for (int axis = 0; axis < reading_.dimension; ++axis) {
      double const most = reading_.box->length(axis);
      if (!reading_.box->periodic(axis) || reach <= most) continue;
      if (reach == no_cutoff)
        reading_.mistake(section_.place(),
                         fmt::format("axis {} is periodic: {} needs a cut-off there, in [run] or here, of at most {}",
                                     "xyz"[axis], called(), reading_.context.units.text(most, dimensions::length, 6)));
      else
        refuse_cutoff(section_.place("cutoff"), reach, axis, reading_);
      break;
    }
    return reach;
  }

  Reading& reading_;
  std::size_t number_;
  PairScheme* pairs_ = reading_.result->pairs;
  SmoothScheme* smooth_ = reading_.result->scheme<SmoothScheme>();
  std::size_t before_;
  Section section_;
  LawInfo const* law_ = nullptr;
  Place law_place_;
  Item const* typed_item_ = nullptr;
  FormulaLaw typed_;
  InfluenceOptions options_;
  Item const *on_ = nullptr, *by_ = nullptr, *between_ = nullptr, *connect_ = nullptr;
  ReadEnsemble *a_ = nullptr, *b_ = nullptr;
  std::optional<std::vector<std::uint32_t>> only_;
  std::vector<Connection> connections_;
  Item const *angles_ = nullptr, *dihedrals_ = nullptr;
  std::vector<AngleMembers> angle_members_;
  std::vector<DihedralMembers> dihedral_members_;
};

}  // namespace

void read_influences(Section& document, Reading& reading) {
  std::size_t number = 0;
  for (Item const* table : find_tables(document, "influences")) {
    std::size_t const this_one = number++;
    if (!table->find("among")) {
      InfluenceReader(*table, this_one, reading, false).read();
      continue;
    }
    std::size_t const before = reading.context.mistakes.count();
    for (auto const& one : influences_among(*table, reading)) {
      InfluenceReader(one, this_one, reading, true).read();
      if (reading.context.mistakes.count() != before) break;  // the others have the same mistakes
    }
  }
}

}  // namespace boltzmann
