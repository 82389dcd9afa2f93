// Shipped laws and what `bzm show` prints of them as typed laws: the same influences and energies.
#include <boltzmann/scenario/classes.hpp>
#include <boltzmann/scenario/laws.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace boltzmann::typed_twins_test {
namespace {

struct Case {
  LawInfo const* law;
  int dimension;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (auto const& law : scenario_laws())
    for (int d = law.least_dimension; d <= law.greatest_dimension; ++d)
      if (!law.typed.in[d - 1].empty()) all.push_back({&law, d});
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
  formula.text = law->typed.in[d - 1];
  double next = 0.7;
  for (auto const& parameter : law->parameters) {
    if (parameter.name == "max_length") next = 20;  // all are nearer
    values.push_back({std::string(parameter.name), {next}});
    formula.parameters.push_back({std::string(parameter.name), next, parameter.dimension.in(d)});
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
    scheme.calculate();
    influences.assign(a->influence(0), a->influence(0) + a->size() * a->influence_size());
    auto const measured = scheme.measure();
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
  formula.text = law->typed.in[d - 1];
  formula.units = UnitSystem::si();
  for (auto const& parameter : law->parameters)
    formula.parameters.push_back({std::string(parameter.name), 1, parameter.dimension.in(d)});
  auto const a = find_class(law->target)->in(d)->make("targets", 2);
  if (law->kind == LawKind::external) {
    EXPECT_NO_THROW(formula.on(*a));
    return;
  }
  auto const b = find_class(law->source == "Particle" ? law->target : law->source)->in(d)->make("sources", 2);
  EXPECT_NO_THROW(formula.between(*a, *b));
}

INSTANTIATE_TEST_SUITE_P(All, Twins, testing::ValuesIn(cases()), [](auto const& info) {
  std::string name = std::string(info.param.law->name) + "_" + std::to_string(info.param.dimension) + "D";
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(TypedTwins, AreOfMostPairLaws) { EXPECT_GE(cases().size(), 25U); }

}  // namespace
}  // namespace boltzmann::typed_twins_test
