// Reads [[influences]]: which law acts on whom.
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/scenario/laws.hpp>
#include <boltzmann/scenario/reading.hpp>

#include <fmt/format.h>

#include <array>

namespace boltzmann {
namespace {

/// [first, last, interval] or [first, last].
std::vector<Connection> read_connections(Item const& item, AnyEnsemble const* ensemble, Reading& reading) {
  std::vector<Connection> connections;
  auto const wrong = [&](Item const& where) {
    reading.mistake(where.place, fmt::format("connect: [[first, last, interval]] is needed, e.g. [[0, 99, 1]], not {}",
                                             found(where)));
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
  return connections;
}

void read_influence(Item const& table, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  Section section(table, "[[influences]]", reading.context);
  std::vector<std::string> names;
  for (auto const& law : scenario_laws()) names.emplace_back(law.name);
  Item const* law_item = section.need("law", "law = \"lennard-jones\"");
  auto const name = law_item ? read_word(*law_item, "law", names, reading.context) : std::nullopt;
  LawInfo const* law = name ? find_law(*name) : nullptr;
  if (law) section.rename(fmt::format("[[influences]] '{}'", *name));
  section.allow("law");
  if (law && reading.smooth.wanted && law->kind == LawKind::pair)
    return reading.mistake(
        law_item->place, fmt::format("law '{}' acts between pairs of particles; smooth particles act on each other by "
                                     "what they are made of, their 'material'",
                                     *name));
  bool const external = law && law->kind == LawKind::external;

  // On whom.
  Item const* on = section.find("on");
  Item const* between = external ? nullptr : section.find("between");
  Item const* one_way = external ? nullptr : section.find("one_way");
  int const given = (on != nullptr) + (between != nullptr) + (one_way != nullptr);
  ReadEnsemble *a = nullptr, *b = nullptr;
  if (external ? on == nullptr && !section.has("between") && !section.has("one_way") : given == 0) {
    reading.mistake(table.place,
                    external ? fmt::format("law '{}' comes from outside and needs 'on', e.g. on = \"atoms\"", *name)
                             : "[[influences]] does not say on whom: add on = \"atoms\", between = [\"a\", "
                               "\"b\"] or one_way = [\"on\", \"by\"]");
  } else if (given > 1) {
    reading.mistake((between ? between : one_way)->place,
                    "[[influences]] needs one of 'on', 'between' and 'one_way', not more");
  } else if (on) {
    a = b = reading.ensemble(*on, "on");
  } else if (given == 1) {
    Item const& pair = between ? *between : *one_way;
    char const* key = between ? "between" : "one_way";
    if (!pair.is(Item::Kind::array) || pair.elements.size() != 2) {
      reading.mistake(pair.place,
                      fmt::format("{}: the names of two ensembles are needed, {}, not {}{}", key,
                                  between ? "[\"a\", \"b\"]" : "[\"on\", \"by\"]", found(pair),
                                  pair.is(Item::Kind::array) ? fmt::format(" of {}", pair.elements.size()) : ""));
    } else {
      a = reading.ensemble(pair.elements[0], key);
      b = reading.ensemble(pair.elements[1], key);
      if (a && a == b) {
        reading.mistake(pair.elements[1].place,
                        fmt::format("{}: '{}' twice; within one ensemble write on = \"{}\"", key, a->name, a->name));
        a = nullptr;
      }
    }
  }

  std::optional<ParameterValues> parameters;
  std::optional<std::vector<std::uint32_t>> only;
  std::vector<Connection> connections;
  Item const* connect = nullptr;
  std::optional<double> cutoff;
  if (law) {
    parameters = read_parameters(section, fmt::format("law '{}'", law->name), law->parameters, reading);
    if (external) {
      only = read_particles(section, a ? a->particles : nullptr, reading);
    } else {
      cutoff = section.quantity("cutoff", dimensions::length, positive);
      connect = section.find("connect");
      if (connect) {
        connections = read_connections(*connect, a ? a->particles : nullptr, reading);
        if (!on && given == 1)
          reading.mistake(connect->place, "connect: connections are within one ensemble; write 'on'");
        if (section.has("cutoff")) reading.mistake(section.place("cutoff"), "cutoff: connections have none");
      }
    }
    section.finish();
  }
  if (reading.context.mistakes.count() != before || !law || !a || !b || !a->particles || !b->particles ||
      !reading.result->scheme || !parameters || (reading.smooth.wanted && !reading.result->smooth))
    return;
  if (reading.result->smooth) {
    if (section.has("particles") || section.has("where"))
      return reading.mistake(section.place(section.has("particles") ? "particles" : "where"),
                             fmt::format("law '{}' acts on all smooth particles of an ensemble; put some of them into "
                                         "one of their own",
                                         *name));
    guarded(reading, law_item->place,
            [&] { install_external(*reading.result->smooth, *law, *parameters, *a->particles); });
    return;
  }
  PairScheme& scheme = *reading.result->pairs;
  if (external) {
    guarded(reading, law_item->place,
            [&] { install_external(scheme, *law, *parameters, *a->particles, only ? &*only : nullptr); });
  } else if (connect) {
    guarded(reading, law_item->place,
            [&] { install_connections(scheme, *law, *parameters, *a->particles, connections); });
  } else {
    if (!cutoff && !reading.run.cutoff_known) return;
    double const reach = cutoff ? *cutoff : reading.run.cutoff.value_or(no_cutoff);
    for (int axis = 0; axis < reading.dimension; ++axis) {
      if (!reading.box->periodic(axis)) continue;
      double const most = reading.box->length(axis);
      if (reach == no_cutoff)
        return reading.mistake(table.place, fmt::format("axis {} is periodic: law '{}' needs a cut-off there, in [run] "
                                                        "or here, of at most {}",
                                                        "xyz"[axis], law -> name, most));
      if (reach > most)
        return reading.mistake(section.place("cutoff"),
                               fmt::format("cutoff: {} is longer than the periodic axis {}, which allows at most {}",
                                           reach, "xyz"[axis], most));
    }
    guarded(reading, law_item->place, [&] {
      install_pairs(scheme, *law, *parameters,
                    on        ? LawUse::internal
                    : between ? LawUse::between
                              : LawUse::one_way,
                    *a->particles, *b->particles, reach);
    });
  }
}

}  // namespace

void read_influences(Section& document, Reading& reading) {
  for (Item const* table : find_tables(document, "influences")) read_influence(*table, reading);
}

}  // namespace boltzmann
