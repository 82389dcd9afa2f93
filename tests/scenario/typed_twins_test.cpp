// Shipped laws, and what `bzm show` prints of them, as typed laws and in the letters of a textbook: the same influences
// and energies; and equations of state, which hold.
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/formulas/formula.hpp>
#include <boltzmann/scenario/catalogue_pages.hpp>
#include <boltzmann/scenario/classes.hpp>
#include <boltzmann/scenario/laws.hpp>
#include <boltzmann/scenario/materials.hpp>

#include "mistakes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <string>

namespace boltzmann::typed_twins_test {
namespace {

struct Case {
  LawInfo const* law;
  int dimension;
  std::string text = {};  ///< as a typed law
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (auto const& law : scenario_laws())
    for (int d = law.least_dimension; d <= law.greatest_dimension; ++d)
      if (!law.typed.in[d - 1].empty()) all.push_back({&law, d, std::string(law.typed.in[d - 1])});
  return all;
}

std::string replaced(std::string const& text, char const* pattern, std::string const& by) {
  return std::regex_replace(text, std::regex(pattern), by);
}

/// "P = B rho, B = ..." in two.
std::vector<std::string> parts_of(std::string const& text) {
  static std::regex const between(R"((?:, |; )(?=\w+ = ))");
  return {std::sregex_token_iterator(text.begin(), text.end(), between, -1), {}};
}

/// "depth [(r0/r)^12 - 2 (r0/r)^6]" as it is typed: a blank between factors multiplies. What follows, "x = a (r - r0)",
/// is put in its place.
std::string typed_from(std::string const& textbook) {
  auto const parts = parts_of(textbook);
  std::string text = parts.front();
  for (std::size_t k = 1; k < parts.size(); ++k) {
    auto const equals = parts[k].find(" = ");
    std::string const letter = "\\b" + parts[k].substr(0, equals) + "\\b";
    text = replaced(text, letter.c_str(), "(" + parts[k].substr(equals + 3) + ")");
  }
  text = replaced(replaced(replaced(text, R"(\[)", "("), R"(\])", ")"), R"(\bln\b)", "log");
  text = replaced(replaced(text, R"(\|([^|]*)\|)", "norm($1)"), R"((\w+) \. (\w+|\([^()]*\)))", "dot($1, $2)");
  return replaced(text, R"(([\w)]) (?=[\w(]))", "$1*");
}

/// What `bzm show` prints of a law has letters that are none of its parameters: what they mean.
struct Notation {
  char const* law;
  std::vector<std::pair<char const*, char const*>> letters;  ///< none: it is not to be typed
};
std::vector<Notation> const notations{
    {"coulomb", {{" in 3D.*", ""}, {"q q'", "p.charge q.charge"}, {"/r$", "/sqrt(r^2 + softening^2)"}}},
    {"gravity", {{" in 3D.*", ""}, {"m m'", "p.mass q.mass"}, {"/r$", "/sqrt(r^2 + softening^2)"}}},
    {"soft", {{"(.*) up to the range", "r < range ? $1 : 0"}}},
    {"pendulum-gravity", {{R"(\bm\b)", "bob_mass"}, {R"(\bl\b)", "length"}, {"cos angle", "cos(x)"}}},
    {"drag", {{"^force ", ""}, {R"(\bv\b)", "velocity"}}},
    {"uniform-gravity", {{R"(\bm\b)", "mass"}, {R"(\bx\b)", "position"}}},
    {"uniform-electric-field", {{R"(\bx\b)", "position"}}},
    {"tether", {{R"(\bx\b)", "position"}}},
    {"shear-flow", {{"^velocity ", ""}, {R"(\bx\b)", "position"}}},
    {"strain-flow", {}},  // "axis by axis"
    {"oscillating-flow", {{R"(\bt\b)", "time"}}},
    {"biot-savart", {}},  // Gamma, k x r and omega
    {"biot-savart-algebraic", {}},
    {"biot-savart-gaussian", {}}};

/// What `bzm show` prints of those that can be typed, in their last dimension.
std::vector<Case> shown_cases() {
  std::vector<Case> all;
  for (auto const& law : scenario_laws()) {
    int const d = law.greatest_dimension;
    auto const notation =
        std::find_if(notations.begin(), notations.end(), [&](auto const& n) { return n.law == law.name; });
    if (law.typed.in[d - 1].empty() || (notation != notations.end() && notation->letters.empty())) continue;
    std::string text(law.formula);
    if (notation != notations.end())
      for (auto const& [letter, meaning] : notation->letters) text = replaced(text, letter, meaning);
    all.push_back({&law, d, typed_from(text)});
  }
  return all;
}

/// Every field a number of its own, positions some way apart.
void fill(AnyEnsemble& particles, double shift) {
  std::uint64_t state = 7;
  auto const some = [&] {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state >> 11U) * 0x1p-53;
  };
  for (std::size_t i = 0; i < particles.size(); ++i)
    for (auto const& field : particles.fields())
      for (int c = 0; c < field.components; ++c)
        particles.row(i)[field.offset + c] = field.name == "position"
                                                 ? shift + 0.8 * static_cast<double>((i >> (2 * c)) & 3U) + 0.3 * some()
                                                 : 0.6 + some();
}

/// Numbers of a vector parameter, the `number`-th of its law: the sum of the first one's is 0, those of others are the
/// same, so that no stream is compressed.
std::vector<double> components(int dimension, int number, double value) {
  std::vector<double> all(static_cast<std::size_t>(dimension), value);
  if (number > 0 || dimension == 1) return all;
  all[1] = dimension == 2 ? -value : 0.5 * value;
  if (dimension == 3) all[2] = -1.5 * value;
  return all;
}

/// "[1 m, 2 m]"
std::string vector_text(std::vector<double> const& numbers, std::string const& unit = "") {
  std::string text;
  for (double const x : numbers) text += fmt::format("{}{}{}", text.empty() ? "" : ", ", x, unit);
  return "[" + text + "]";
}

class Twins : public testing::TestWithParam<Case> {};

TEST_P(Twins, HaveTheSameInfluencesAndEnergies) {
  LawInfo const* const law = GetParam().law;
  int const d = GetParam().dimension;
  auto const& target_class = *find_class(law->target)->in(d);
  bool const one_way = law->kind != LawKind::external && (law->symmetry == Symmetry::one_way ||
                                                          (law->source != "Particle" && law->source != law->target));
  auto const& source_class = one_way ? *find_class(law->source)->in(d) : target_class;
  ParameterValues values;
  FormulaLaw formula;
  formula.gives = law->has_energy ? FormulaLaw::Gives::energy : FormulaLaw::Gives::influence;
  formula.text = GetParam().text;
  double next = 0.7;
  int vectors = 0;
  for (auto const& parameter : law->parameters) {
    std::string const name(parameter.name);
    if (name == "max_length") next = 20;  // all are nearer
    if (parameter.vector) {
      values.push_back({name, components(d, vectors++, next)});
      formula.where.push_back({name, vector_text(values.back().second)});
    } else {
      values.push_back({name, {next}});
      formula.parameters.push_back({name, next, parameter.dimension.in(d)});
    }
    next += parameter.range.high < 1.5 ? 0 : 0.3;
  }
  Vector<3> const low{-1., -1., -1.}, high{9., 9., 9.};
  auto const box = [&] {
    if (d == 1) return Box(Vector<1>{-1.}, Vector<1>{9.}, Boundary::open);
    if (d == 2) return Box(Vector<2>{-1., -1.}, Vector<2>{9., 9.}, Boundary::open);
    return Box(low, high, Boundary::open);
  };
  auto const run = [&](bool typed, std::vector<double>& influences) {
    auto const a = target_class.make("targets", d == 1 ? 4 : 16), b = source_class.make("sources", 12);
    fill(*a, 0), fill(*b, 0.45);
    PairScheme scheme(box());
    if (law->kind == LawKind::external) {
      typed ? scheme.external(*a, formula) : install_external(scheme, *law, values, *a, nullptr);
    } else if (one_way) {
      typed ? scheme.one_way(*a, *b, formula) : install_pairs(scheme, *law, values, LawUse::one_way, *a, *b, no_cutoff);
    } else {
      typed ? scheme.internal(*a, formula) : install_pairs(scheme, *law, values, LawUse::internal, *a, *a, no_cutoff);
    }
    scheme.calculate(0.4);
    influences.assign(a->influence(0), a->influence(0) + a->size() * a->influence_size());
    auto const measured = scheme.measure(0.4);
    return law->kind == LawKind::external ? measured.external : measured.potential;
  };
  std::vector<double> compiled, typed;
  double const energy = run(false, compiled), typed_energy = run(true, typed);
  ASSERT_EQ(compiled.size(), typed.size());
  double largest = 0;
  for (double const x : compiled) largest = std::max(largest, std::fabs(x));
  EXPECT_GT(largest, 0);
  for (std::size_t k = 0; k < compiled.size(); ++k) EXPECT_NEAR(compiled[k], typed[k], 1e-12 * largest) << k;
  if (law->has_energy) {
    EXPECT_NE(energy, 0);
    EXPECT_NEAR(energy, typed_energy, 1e-12 * std::fabs(energy));
  }
}

// With units the same texts are energies, or what the law's class is moved by.
TEST_P(Twins, HaveTheDimensionsOfTheirLaw) {
  LawInfo const* const law = GetParam().law;
  int const d = GetParam().dimension;
  FormulaLaw formula;
  formula.gives = law->has_energy ? FormulaLaw::Gives::energy : FormulaLaw::Gives::influence;
  formula.text = GetParam().text;
  formula.units = UnitSystem::si();
  for (auto const& parameter : law->parameters) {
    std::string const name(parameter.name);
    auto const units = example_units(parameter.dimension.in(d));
    if (parameter.vector)
      formula.where.push_back({name, vector_text(components(d, 0, 1), units.empty() ? "" : " " + units.front())});
    else
      formula.parameters.push_back({name, 1, parameter.dimension.in(d)});
  }
  auto const a = find_class(law->target)->in(d)->make("targets", 2);
  if (law->kind == LawKind::external) {
    EXPECT_NO_THROW(formula.on(*a));
    return;
  }
  auto const b = find_class(law->source == "Particle" ? law->target : law->source)->in(d)->make("sources", 2);
  EXPECT_NO_THROW(formula.between(*a, *b));
}

std::string name_of(testing::TestParamInfo<Case> const& info) {
  std::string name = std::string(info.param.law->name) + "_" + std::to_string(info.param.dimension) + "D";
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(All, Twins, testing::ValuesIn(cases()), name_of);
INSTANTIATE_TEST_SUITE_P(Shown, Twins, testing::ValuesIn(shown_cases()), name_of);

// Which laws have none, and why.
TEST(TypedTwins, AreOfAllLawsThatCanBeTyped) {
  struct Untyped {
    char const *law, *why;
    int greatest_dimension = 3;
  };
  static constexpr Untyped untyped[] = {
      {"coulomb",
       "in 1D and 2D charges are those of sheets and rods of length 1, whose energies are none by their units", 2},
      {"gravity", "in 1D and 2D masses are those of sheets and rods of length 1", 2},
      {"vorticity-exchange", "it changes vorticity, not places: an influence on a field of one's own class may"},
      {"pendulum-coupling", "it depends on both angles, not on their difference alone"},
      {"uniform-magnetic-field", "its energy is zero, but no gradient gives its force; and the leap-frog turns by it"},
  };
  for (auto const& law : scenario_laws())
    for (int d = law.least_dimension; d <= law.greatest_dimension; ++d) {
      bool const expected = std::none_of(std::begin(untyped), std::end(untyped), [&](Untyped const& one) {
        return law.name == one.law && d <= one.greatest_dimension;
      });
      EXPECT_EQ(!law.typed.in[d - 1].empty(), expected) << law.name << " in " << d << "D";
    }
}

/// The table for this dimension.
std::string shown_table(std::string const& page, int dimension) {
  auto heading = page.find(fmt::format("the same as a formula law, in {}D", dimension));
  if (heading == std::string::npos) heading = page.find("the same as a formula law");
  auto const from = page.find("    [[influences]]", heading);
  return heading == std::string::npos ? "" : page.substr(from, page.find("\n\n", from) - from) + "\n";
}

bool is_of_state(std::string const& part) {
  return part.starts_with("P = ") || part.starts_with("e = ") || part.starts_with("T = ");
}

/// Equations of state as `bzm show` prints them: each holds for what the material makes of a density and an energy.
TEST(ShownEquationsOfState, HoldForTheStatesOfAllMaterials) {
  int equations = 0;
  for (auto const& material : material_catalogue()) {
    if (material.tabulated || material.typed) continue;
    SCOPED_TRACE(material.name);
    MaterialChoice choice;
    choice.info = &material;
    for (auto const& parameter : flux_parameters()) choice.fluxes.push_back({std::string(parameter.name), {0}});
    FormulaInputs names(3, UnitSystem::reduced());
    for (auto const* name : {"rho", "e", "P", "T"}) names.add(name, {});
    double next = 1.4;
    for (auto const& parameter : material.parameters) {
      choice.parameters.push_back({std::string(parameter.name), {next}});
      names.define(std::string(parameter.name), next, {});
      next += 0.3;
    }
    auto const bound = bind_material(choice, Matter::fluid, 3);
    auto const gas = find_class("Smooth")->in(3)->make("gas", 1);
    auto const field = [&](char const* name) -> double& { return gas->row(0)[gas->field(name).offset]; };
    field("mass") = 1, field("range") = 2, field("density") = 0.3, field("specific_energy") = 20;
    double fluid[row_block];
    std::uint32_t const order[] = {0};
    Found found;
    MaterialTask task;
    task.particles = gas->row(0), task.particle_stride = gas->stride(), task.order = order;
    task.fluid = fluid, task.found = &found;
    bound.kernels.state(bound.material.get(), task, 0, 1);
    std::array const state{field("density"), field("specific_energy"), field("pressure"), field("temperature")};
    std::string letters;  // what else stands in its equations
    auto const all = parts_of(std::string(material.formula));
    for (auto const& part : all)
      if (!is_of_state(part)) letters += ", " + part;
    for (auto const& part : all) {
      if (!is_of_state(part)) continue;
      double const stated = names.read(part.substr(0, 1))(state);
      EXPECT_GT(std::abs(stated), 1e-3) << part;
      EXPECT_NEAR(names.read(typed_from(part.substr(4) + letters))(state), stated, 1e-12 * std::abs(stated)) << part;
      ++equations;
    }
  }
  EXPECT_GE(equations, 11);
}

// What `bzm show` prints of a law can be put into a scenario.
TEST(TypedTwins, CanBeCopiedIntoScenarios) {
  for (auto const& [law, d, typed] : cases()) {
    auto const page = catalogue_page(std::string(law->name));
    if (d < law->greatest_dimension && page.find("with its vectors in") != std::string::npos) continue;
    bool const carried = law->target == "Tracer" && law->kind == LawKind::pair;
    std::string const name(carried ? law->source : law->target), table = shown_table(page, d);
    auto const list = [d = d](char const* text) {
      return "[" + join(std::vector<std::string>(static_cast<std::size_t>(d), text)) + "]";
    };
    auto const nobody = find_class(name)->in(d)->make("", 0);
    std::string fields;
    for (char const* field : {"mass", "core"})
      if (nobody->find_field(field)) fields += std::string(field) + " = 1\n";
    std::string const text = "[units]\nbase = \"si\"\n[box]\nlow = " + list("0") + "\nhigh = " + list("90") +
                             "\nboundary = \"open\"\n[run]\nstep = 0.01\nsteps = 2\n[[ensembles]]\nname = \"some\"\n" +
                             "class = \"" + name + "\"\nnumber = 3\nload = { kind = \"random\" }\n" + fields +
                             test::replaced(table, "\"...\"", "\"some\"");
    EXPECT_EQ(test::mistakes_of(text), std::vector<std::string>()) << text;
  }
}

}  // namespace
}  // namespace boltzmann::typed_twins_test
