// Reads molecules: bonds between particles, and tuples of them.
#include <boltzmann/core/input_file.hpp>
#include <boltzmann/dissipation/rigid_motion.hpp>
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/scenario/tables.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace boltzmann {
namespace {

/// N integers on each line of a file; comments start with #.
template <std::size_t N>
std::vector<std::array<std::uint32_t, N>> read_file(std::string const& path) {
  auto const file = open_text(path, "file");
  std::vector<std::array<std::uint32_t, N>> all;
  std::vector<int> lines;
  std::string line;
  for (int number = 1; read_line(*file, line, path); ++number) {
    line = line.substr(0, line.find('#'));
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    std::istringstream words(line);
    std::array<std::uint32_t, N> members{};
    std::string rest;
    bool good = line.find('-') == std::string::npos;
    for (auto& i : members) good = good && words >> i;
    if (!good || words >> rest)
      throw Error(fmt::format("{}:{}: {} numbers of particles are needed, not '{}'", path, number, N, line));
    all.push_back(members);
    lines.push_back(number);
  }
  refuse_repeated(
      all, [&](std::size_t k) { return fmt::format("line {}", lines[k]); }, path);
  return all;
}

template <std::size_t N>
std::vector<std::array<std::uint32_t, N>> read_list(Item const& item, char const* key, Reading& reading) {
  std::vector<std::array<std::uint32_t, N>> all;
  for (auto const& element : item.elements) {
    if (!element.is(Item::Kind::array) || element.elements.size() != N) {
      reading.mistake(element.place,
                      fmt::format("{}: lists of {} particle numbers are needed, not {}", key, N, describe(element)));
      return {};
    }
    std::array<std::uint32_t, N> members{};
    for (std::size_t m = 0; m < N; ++m) {
      auto const i = read_integer(element.elements[m], key, 0, 4'000'000'000, reading.context);
      if (!i) return {};
      members[m] = static_cast<std::uint32_t>(*i);
    }
    all.push_back(members);
  }
  catch_errors(reading, item.place, [&] {
    refuse_repeated(
        all,
        [&](std::size_t k) {
          return fmt::format("line {}:{}", item.elements[k].place.line, item.elements[k].place.column);
        },
        key);
  });
  return all;
}

/// A list or { file = "..." }. Numbers are relative to a molecule, and repeated for each, if there are molecules.
template <std::size_t N>
std::vector<std::array<std::uint32_t, N>> read_tuples(Item const& item, char const* key, AnyEnsemble const* particles,
                                                      ReadMolecules const& molecules, char const* example,
                                                      Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  std::vector<std::array<std::uint32_t, N>> all;
  if (item.is(Item::Kind::table)) {
    Section file(item, key, reading.context);
    Item const* path_item = file.need("file", "file = \"bonds.txt\"");
    auto const path = path_item ? read_path(*path_item, fmt::format("{}.file", key), reading.context) : std::nullopt;
    file.finish();
    if (path) catch_errors(reading, item.place, [&] { all = read_file<N>(*path); });
  } else if (item.is(Item::Kind::array)) {
    all = read_list<N>(item, key, reading);
  } else {
    reading.mistake(item.place, fmt::format("{}: {} is needed, not {}", key, example, describe(item)));
  }
  if (!particles || reading.context.mistakes.count() != before) return {};
  std::size_t const length = molecules.length > 0 ? molecules.length : particles->size();
  catch_errors(reading, item.place, [&] {
    try {
      all = repeated(all, length, particles->size());
    } catch (Error const& error) {
      throw Error(fmt::format("{}: {}", key, error.what()));
    }
  });
  return all;
}

/// True if the item is the text "bonds", and the ensemble has bonds.
bool means_bonds(Item const& item, char const* key, ReadEnsemble const* of, Reading& reading) {
  if (!item.is(Item::Kind::text) || !read_word(item, key, {"bonds"}, reading.context)) return false;
  if (of && of->particles && of->molecules.bonds.empty())
    reading.mistake(item.place, fmt::format("{}: '{}' has no bonds; its [[ensembles]] gives them, bonds = \"chain\" or "
                                            "[[0, 1], [0, 2]]",
                                            key, of->name));
  return true;
}

}  // namespace

void read_bonds(Section& section, AnyEnsemble const* particles, ReadMolecules& molecules, Reading& reading) {
  if (particles && molecules.length > 0 && particles->size() % molecules.length != 0)
    reading.mistake(section.place("molecule"), fmt::format("molecule: {} particles are no whole number of molecules of "
                                                           "{}",
                                                           particles->size(), molecules.length));
  Item const* item = section.find("bonds");
  if (!item) return;
  if (item->is(Item::Kind::text)) {
    if (!read_word(*item, "bonds", {"chain"}, reading.context) || !particles) return;
    catch_errors(reading, item->place, [&] {
      molecules.bonds = chain_bonds(particles->size(), molecules.length > 0 ? molecules.length : particles->size());
    });
    return;
  }
  molecules.bonds =
      read_tuples<2>(*item, "bonds", particles, molecules, "\"chain\", [[0, 1], [0, 2]] or a file", reading);
  catch_errors(reading, item->place, [&] { connections_of(molecules.bonds); });
}

bool connects_bonds(Item const& item, ReadEnsemble const* of, Reading& reading) {
  return means_bonds(item, "connect", of, reading);
}

std::vector<AngleMembers> read_angles(Item const& item, ReadEnsemble const* of, Reading& reading) {
  static ReadEnsemble const none{};
  ReadEnsemble const& one = of ? *of : none;
  if (item.is(Item::Kind::text))
    return means_bonds(item, "angles", of, reading) ? angles_along(one.molecules.bonds) : std::vector<AngleMembers>{};
  return read_tuples<3>(item, "angles", one.particles, one.molecules, "\"bonds\", [[0, 1, 2]] or a file", reading);
}

std::vector<DihedralMembers> read_dihedrals(Item const& item, ReadEnsemble const* of, Reading& reading) {
  static ReadEnsemble const none{};
  ReadEnsemble const& one = of ? *of : none;
  if (item.is(Item::Kind::text))
    return means_bonds(item, "dihedrals", of, reading) ? dihedrals_along(one.molecules.bonds)
                                                       : std::vector<DihedralMembers>{};
  return read_tuples<4>(item, "dihedrals", one.particles, one.molecules, "\"bonds\", [[0, 1, 2, 3]] or a file",
                        reading);
}

namespace {

/// Creates rigid bonds from one table.
void read_rigid(Item const& table, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  Section section(table, "[[rigid_bonds]]", reading.context);
  RigidBondOptions options;
  read_options(section, rigid_bond_options(), &options, {.dimension = reading.dimension});
  Item const *on = section.find("on"), *pairs = section.find("pairs");
  ReadEnsemble* of = on ? reading.ensemble(*on, "on") : nullptr;
  std::vector<BondMembers> bonds;
  if (pairs && !pairs->is(Item::Kind::text))
    bonds = read_tuples<2>(*pairs, "pairs", of ? of->particles : nullptr, of ? of->molecules : ReadMolecules{},
                           "\"bonds\", [[0, 1], [0, 2]] or a file", reading);
  else if (of && (!pairs || means_bonds(*pairs, "pairs", of, reading)))
    bonds = of->molecules.bonds;
  section.finish();
  if (reading.context.mistakes.count() != before || !of || !of->particles || !reading.box) return;
  if (bonds.empty())
    return reading.mistake(section.place(), fmt::format("[[rigid_bonds]]: '{}' has no bonds; its [[ensembles]] gives "
                                                        "them, bonds = \"chain\", or add pairs = [[0, 1]]",
                                                        of->name));
  catch_errors(reading, section.place(), [&] {
    auto rigid = std::find_if(reading.rigid.begin(), reading.rigid.end(),
                              [&](auto const& one) { return &one->ensemble() == of->particles; });
    if (rigid != reading.rigid.end()) return (*rigid)->add(bonds, options.length);
    MoleculeScheme& scheme = molecule_scheme(reading);
    auto made = std::make_shared<RigidBonds>(*of->particles, scheme.box(), bonds, options.length, options.tolerance);
    if (of->integrator) of->integrator = with_rigid_bonds(made, std::move(of->integrator));
    scheme.keeps(made);
    reading.rigid.push_back(std::move(made));
  });
}

}  // namespace

void read_rigid_bonds(Section& document, Reading& reading) {
  auto const tables = find_tables(document, "rigid_bonds");
  for (Item const* table : tables) read_rigid(*table, reading);
  for (auto const& rigid : reading.rigid) {
    catch_errors(reading, tables.front()->place, [&] { rigid->settle(); });
    reading.behind_baths.push_back([rigid, &reading](Simulation& simulation) {
      if (simulation.dissipations().empty()) return;
      reading.result->dissipations.push_back(std::make_unique<RigidVelocities>(rigid));
      simulation.add(*reading.result->dissipations.back());
    });
  }
}

MoleculeScheme& molecule_scheme(Reading& reading) {
  if (auto* there = reading.result->scheme<MoleculeScheme>()) return *there;
  auto made = std::make_unique<MoleculeScheme>(*reading.box);
  made->threads(reading.run.threads);
  MoleculeScheme& scheme = *made;
  reading.result->schemes.push_back(std::move(made));
  return scheme;
}

}  // namespace boltzmann
