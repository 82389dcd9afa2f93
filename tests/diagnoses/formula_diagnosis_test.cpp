// Diagnoses by formula, against sums by hand; quantities that are formulas.
#include <boltzmann/boltzmann.hpp>
#include <boltzmann/core/units.hpp>
#include <boltzmann/diagnoses/derived.hpp>
#include <boltzmann/diagnoses/diagnosis_catalogue.hpp>
#include <boltzmann/diagnoses/formula_diagnosis.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace boltzmann::formula_diagnosis_test {
namespace {

template <int D>
struct Gas {
  Ensemble<Newton<D>> atoms{"atoms", 50}, others{"others", 20};
  Box box;
  Gas() : box(corner(0), corner(10), Boundary::periodic) {
    double angle = 0.3;
    for (auto* ensemble : {&atoms, &others})
      for (std::size_t i = 0; i < ensemble->size(); ++i) {
        auto& p = (*ensemble)[i];
        p.mass = 1 + 0.1 * static_cast<double>(i % 7);
        for (int a = 0; a < D; ++a) {
          p.position[a] = 5 + 4 * std::sin(angle += 1.1);
          p.velocity[a] = std::cos(angle += 0.7) + 0.4;
        }
      }
  }
  static Vector<D> corner(double x) {
    Vector<D> at;
    for (int a = 0; a < D; ++a) at[a] = x;
    return at;
  }
  DiagnosisParameters parameters(std::string const& formula) const {
    DiagnosisParameters all;
    all.available = {&atoms, &others};
    all.ensembles = {"atoms"};
    all.label = "it";
    all.formula = formula;
    return all;
  }
  std::vector<double> measure(Diagnosis& diagnosis) {
    std::vector<AnyEnsemble*> const all{&atoms, &others};
    std::vector<double> values;
    diagnosis.measure({all, box, nullptr, 1, 2.5, 100}, values);
    EXPECT_EQ(values.size(), diagnosis.columns().size());
    return values;
  }
  double value(std::string const& formula) { return measure(*make_diagnosis("formula", parameters(formula))).at(0); }
  template <class F>
  double mean(F const& f) const {
    double sum = 0;
    for (std::size_t i = 0; i < atoms.size(); ++i) sum += f(atoms[i]);
    return sum / static_cast<double>(atoms.size());
  }
};

template <int D>
void sums_by_hand() {
  Gas<D> gas;
  double const n = 50;
  auto const x = [](auto const& p) { return p.velocity[0]; };
  double const mean = gas.mean(x);
  EXPECT_NEAR(gas.value("mean(velocity.x)"), mean, 1e-14);
  EXPECT_NEAR(gas.value("sum(mass)"), n * gas.mean([](auto const& p) { return p.mass; }), 1e-12);
  EXPECT_NEAR(gas.value("mean((velocity.x - mean(velocity.x))^2)"),
              gas.mean([&](auto const& p) { return (x(p) - mean) * (x(p) - mean); }), 1e-14);
  EXPECT_NEAR(gas.value("sum(0.5*mass*dot(velocity, velocity))"), kinetic_energy(gas.atoms), 1e-12);
  double order = 0, speed = gas.mean([](auto const&p) { return magnitude(p.velocity); });
  for (int a = 0; a < D; ++a) order += std::pow(gas.mean([&](auto const& p) { return p.velocity[a]; }), 2);
  EXPECT_NEAR(gas.value("norm(mean(velocity))/mean(speed)"), std::sqrt(order) / speed, 1e-14);
  double least = 1e9, greatest = -1e9;
  for (std::size_t i = 0; i < 50; ++i)
    least = std::min(least, x(gas.atoms[i])), greatest = std::max(greatest, x(gas.atoms[i]));
  EXPECT_EQ(gas.value("min(velocity.x)"), least);
  EXPECT_EQ(gas.value("max(velocity.x) - min(velocity.x)"), greatest - least);
  EXPECT_NEAR(gas.value("mean(min(velocity.x, 0))"), gas.mean([&](auto const& p) { return std::min(x(p), 0.); }),
              1e-14);
  EXPECT_EQ(gas.value("number*time"), 125);
  EXPECT_NEAR(gas.value("sum(x < 5 ? 1 : 0)/number"), gas.mean([](auto const& p) { return p.position[0] < 5 ? 1 : 0; }),
              1e-14);
}
TEST(FormulaDiagnosis, IsTheSumByHand) { sums_by_hand<1>(), sums_by_hand<2>(), sums_by_hand<3>(); }

TEST(FormulaDiagnosis, HasColumnsOfEachEnsembleAndComponent) {
  Gas<3> gas;
  auto parameters = gas.parameters("mean(velocity)");
  auto const names = [](Diagnosis const& diagnosis) {
    std::vector<std::string> all;
    for (auto const& column : diagnosis.columns()) all.push_back(column.name);
    return all;
  };
  auto diagnosis = make_diagnosis("formula", parameters);
  EXPECT_EQ(names(*diagnosis), (std::vector<std::string>{"it x", "it y", "it z"}));
  EXPECT_NEAR(gas.measure(*diagnosis)[2], gas.mean([](auto const& p) { return p.velocity[2]; }), 1e-14);
  parameters.ensembles = {};
  parameters.formula = "sum(mass)";
  diagnosis = make_diagnosis("formula", parameters);
  EXPECT_EQ(names(*diagnosis), (std::vector<std::string>{"atoms it", "others it"}));
  EXPECT_NEAR(gas.measure(*diagnosis)[1], total_mass(gas.others), 1e-12);
  parameters.ensembles = {"atoms"};
  parameters.particles = {3, 4};
  EXPECT_NEAR(gas.measure(*make_diagnosis("formula", parameters))[0], gas.atoms[3].mass + gas.atoms[4].mass, 1e-14);
}

TEST(FormulaDiagnosis, HasTheDimensionOfItsFormula) {
  Gas<2> gas;
  auto parameters = gas.parameters("sum(e)/number");
  parameters.units = UnitSystem::si();
  parameters.formula_parts = {{"e", "0.5*mass*speed^2 + g*y"}};
  parameters.formula_parameters = {{"g", 2, dimensions::force}};
  auto const diagnosis = make_diagnosis("formula", parameters);
  EXPECT_EQ(diagnosis->columns()[0].dimension, dimensions::energy);
  EXPECT_NEAR(gas.measure(*diagnosis)[0],
              kinetic_energy(gas.atoms) / 50 + 2 * gas.mean([](auto const& p) { return p.position[1]; }), 1e-12);
}

TEST(FormulaDiagnosis, SaysWhatIsWrong) {
  Gas<2> gas;
  auto const told = [&](DiagnosisParameters const& parameters, char const* kind = "formula") -> std::string {
    try {
      make_diagnosis(kind, parameters);
    } catch (Error const& error) {
      return error.what();
    }
    return "";
  };
  auto const has = [](std::string const& text, std::string const& part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_PRED2(has, told(gas.parameters("velocity.x")), "'velocity' is of one particle; for many take its mean(...)");
  EXPECT_PRED2(has, told(gas.parameters("mean(mass) + mass")), "'mass' is of one particle");
  EXPECT_PRED2(has, told(gas.parameters("mean(charge)")), "unknown name 'charge'");
  EXPECT_PRED2(has, told(gas.parameters("meen(mass)")), "did you mean 'mean'?");
  EXPECT_PRED2(has, told(gas.parameters("mean(mass, 2)")), "mean takes 1 value, not 2");
  EXPECT_PRED2(has, told(gas.parameters("max(velocity)")), "a number is needed here, not a vector");
  EXPECT_PRED2(has, told(gas.parameters("")), "a formula is needed");
  auto parameters = gas.parameters("mean(mass + x)");
  parameters.units = UnitSystem::si();
  EXPECT_PRED2(has, told(parameters), "a mass and a length can't be added");
  parameters = gas.parameters("1");
  parameters.formula_parts = {{"mass", "2"}};
  EXPECT_PRED2(has, told(parameters), "'mass' means something else");
  EXPECT_PRED2(has, told(gas.parameters("speed"), "histogram"), "'from' and 'to'");
}

TEST(HistogramDiagnosis, CountsPartsOfAllParticles) {
  Gas<2> gas;
  auto parameters = gas.parameters("speed");
  parameters.from = 0;
  parameters.to = 3;
  parameters.count = 6;
  auto const diagnosis = make_diagnosis("histogram", parameters);
  auto const found = gas.measure(*diagnosis);
  EXPECT_EQ(diagnosis->columns()[1].name, "it 0.5 to 1");
  for (std::size_t k = 0; k < 6; ++k)
    EXPECT_NEAR(found[k], gas.mean([&](auto const& p) {
      double const v = magnitude(p.velocity);
      return v >= 0.5 * static_cast<double>(k) && v < 0.5 * static_cast<double>(k + 1) ? 1. : 0.;
    }),
                1e-14);
  EXPECT_NEAR(std::accumulate(found.begin(), found.end(), 0.), 1, 1e-12);
}

TEST(Quantity, MayBeAFormula) {
  Gas<3> gas;
  auto const units = UnitSystem::si();
  auto const values = quantity(gas.atoms, "0.5*mass*dot(velocity, velocity)");
  auto const known = quantity(gas.atoms, "kinetic-energy");
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(values[i], known[i], 1e-14);
  EXPECT_EQ(quantity_meaning(gas.atoms, "0.5*mass*speed^2").dimension, dimensions::energy);
  EXPECT_EQ(quantity_meaning(gas.atoms, "0.5*mass*speed^2").label, "0.5*mass*speed^2");
  EXPECT_EQ(quantity_meaning(gas.atoms, "kinetic_energy/mass").dimension, dimensions::specific_energy);
  EXPECT_EQ(quantity_meaning(gas.atoms, "norm(influence)/mass", &units).dimension, dimensions::acceleration);
  EXPECT_NEAR(quantity(gas.atoms, "speed/(2 m/s)", {}, &units)[3], quantity(gas.atoms, "speed")[3] / 2, 1e-14);
  std::vector<double> const potential(50, 7);
  EXPECT_NEAR(quantity(gas.atoms, "potential_energy + kinetic_energy", potential)[5], 7 + known[5], 1e-14);
  EXPECT_TRUE(has_quantity(gas.atoms, "x - 5"));
  EXPECT_FALSE(has_quantity(gas.atoms, "x - mass", &units));
  EXPECT_FALSE(has_quantity(gas.atoms, "velocity"));
  EXPECT_FALSE(has_quantity(gas.atoms, "charge"));
  auto const told = [&](char const* name) -> std::string {
    try {
      quantity(gas.atoms, name);
    } catch (Error const& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(told("kinetic-enrgy").find("did you mean 'kinetic-energy'?"), std::string::npos);
  EXPECT_NE(told("velocity").find("did you mean 'velocity.x'?"), std::string::npos);
  EXPECT_NE(told("sqrt(mas)").find("formula 'sqrt(mas)' of particles of 'atoms': unknown name 'mas'"),
            std::string::npos)
      << told("sqrt(mas)");
  EXPECT_NE(told("2*velocity").find("norm(...) is its length"), std::string::npos);
}

}  // namespace
}  // namespace boltzmann::formula_diagnosis_test
