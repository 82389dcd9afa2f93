// The catalogue of diagnoses: columns, values and dimensions of every kind, groups that are remembered, and refusals.
#include <boltzmann/core/error.hpp>
#include <boltzmann/diagnoses/derived.hpp>
#include <boltzmann/diagnoses/diagnosis_catalogue.hpp>
#include <boltzmann/diagnoses/spectrum_of.hpp>
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/particles/panel.hpp>
#include <boltzmann/particles/smooth.hpp>
#include <boltzmann/particles/vortex.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <tests/message.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace boltzmann::diagnosis_catalogue_test {
namespace {

/// Two atoms and a fluid particle in 2D, and everything that a diagnosis wants.
class Diagnoses : public testing::Test {
 protected:
  Diagnoses() : scheme_(Box(Vector<2>{0, 0}, Vector<2>{4, 5})) {
    atoms_[0] = {{{1.0, 1.0}}, 2, {3.0, 0.0}};
    atoms_[1] = {{{2.0, 1.0}}, 4, {0.0, -1.0}};
    fluid_.influence(0)[1] = 7;
    scheme_.internal(atoms_, LennardJones{0.5, 1});
    scheme_.external(atoms_, [](auto const& p) { return Interaction{p.position * 0.0, p.mass * p.position[1]}; });
    scheme_.add(fluid_);
    measures_ = scheme_.measure();
  }

  DiagnosisParameters parameters() const { return {.available = {&atoms_, &fluid_}}; }
  Sample sample() const { return {scheme_.ensembles(), scheme_.box(), &measures_, 0.5, 0, 0}; }

  std::map<std::string, double> look(Diagnosis& diagnosis) const {
    std::vector<double> values{-1};  // appends: what is there stays
    diagnosis.measure(sample(), values);
    auto const columns = diagnosis.columns();
    EXPECT_EQ(values.size(), 1 + columns.size());
    std::map<std::string, double> named;
    for (std::size_t c = 0; c < columns.size(); ++c) named[columns[c].name] = values[c + 1];
    EXPECT_EQ(named.size(), columns.size()) << "two columns of one name";
    return named;
  }
  std::map<std::string, double> look(std::string const& kind, DiagnosisParameters const& with) const {
    return look(*make_diagnosis(kind, with));
  }

  Ensemble<Newton<2>> atoms_{"atoms", 2};
  Ensemble<Tracer<2>> fluid_{"fluid", 1};
  PairScheme scheme_;
  EnergyAndVirial measures_ = EnergyAndVirial::known();
};

using Values = std::map<std::string, double>;

TEST_F(Diagnoses, OfTheWholeSystem) {
  EXPECT_EQ(look("number", parameters()), (Values{{"number", 3}, {"mass", 6}}));
  EXPECT_EQ(look("momentum", parameters()), (Values{{"momentum x", 6}, {"momentum y", -4}}));
  EXPECT_EQ(look("angular-momentum", parameters()), (Values{{"angular momentum", -6 - 8}}));
  // Sum m v_x^2 = 18, Sum m v_y^2 = 4, k = 0.5, two particles
  EXPECT_EQ(look("temperature", parameters()),
            (Values{{"temperature", 11}, {"temperature x", 18}, {"temperature y", 4}}));
  // at its minimum the pair has -depth and no force; the field has 2 * 1 + 4 * 1
  EXPECT_EQ(look("energies", parameters()), (Values{{"kinetic energy", 11},
                                                    {"potential energy", -0.5},
                                                    {"external energy", 6},
                                                    {"internal energy", 0},
                                                    {"total energy", 16.5}}));
  auto const p = look("pressure", parameters());
  EXPECT_NEAR(p.at("pressure"), 22.0 / (2 * 20), 1e-14);
  EXPECT_NEAR(p.at("pressure xx"), 18.0 / 20, 1e-14);
  EXPECT_NEAR(p.at("pressure xy"), 0, 1e-14);
  EXPECT_NEAR(p.at("pressure yy"), 4.0 / 20, 1e-14);
}

TEST_F(Diagnoses, OfNamedEnsembles) {
  auto with = parameters();
  with.ensembles = {"fluid", "atoms"};
  EXPECT_EQ(look("number", with),
            (Values{{"fluid number", 1}, {"fluid mass", 0}, {"atoms number", 2}, {"atoms mass", 6}}));
  auto const energies = look("energies", with);
  EXPECT_EQ(energies.at("fluid kinetic energy"), 0);
  EXPECT_EQ(energies.at("atoms kinetic energy"), 11);
  EXPECT_EQ(energies.at("kinetic energy"), 11);
  EXPECT_EQ(energies.at("total energy"), 16.5);
  with.ensembles = {"atoms"};
  with.subtract_drift = true;
  // drift (1, -2/3): Sum m (v - u)^2 = 18 - 6 and 4 - 6 * 4/9, over one degree of freedom each
  auto const t = look("temperature", with);
  EXPECT_NEAR(t.at("atoms temperature x"), 24, 1e-12);
  EXPECT_NEAR(t.at("atoms temperature y"), 8 - 16.0 / 3, 1e-12);
  with.subtract_drift = false;
  with.about_centre_of_mass = true;
  // About (5/3, 1): 2 (-2/3 * 0 - 0 * 3) + 4 (1/3 * -1)
  EXPECT_NEAR(look("angular-momentum", with).at("atoms angular momentum"), -4.0 / 3, 1e-12);
}

TEST_F(Diagnoses, UnknownEnergiesAreNaNAndTheColumnsStay) {
  measures_.unknown = "a law on 'atoms'";
  auto const energies = look("energies", parameters());
  EXPECT_EQ(energies.at("kinetic energy"), 11);
  for (char const* name : {"potential energy", "external energy", "internal energy", "total energy"})
    EXPECT_TRUE(std::isnan(energies.at(name)));
  auto with = parameters();
  with.quantity = "potential-energy";
  EXPECT_TRUE(std::isnan(look("extremes", with).at("atoms potential energy mean")));
  measures_.unknown = "";
  EXPECT_EQ(look("extremes", with).at("atoms potential energy mean"), -0.25);
  EXPECT_EQ(look("extremes", with).at("fluid potential energy mean"), 0);
}

TEST_F(Diagnoses, Groups) {
  EXPECT_EQ(look("mean-velocity", parameters()), (Values{{"atoms mean velocity x", 1.5},
                                                         {"atoms mean velocity y", -0.5},
                                                         {"fluid mean velocity x", 0},
                                                         {"fluid mean velocity y", 7}}));
  EXPECT_EQ(look("velocity-diffusion", parameters()),
            (Values{{"atoms velocity spread", 2.25 + 0.25}, {"fluid velocity spread", 0}}));
  auto with = parameters();
  with.ensembles = {"atoms"};
  with.particles = {1};
  with.label = "beam";
  EXPECT_EQ(look("mean-velocity", with), (Values{{"beam mean velocity x", 0}, {"beam mean velocity y", -1}}));
  with.quantity = "speed";
  EXPECT_EQ(look("extremes", with),
            (Values{{"beam speed minimum", 1}, {"beam speed maximum", 1}, {"beam speed mean", 1}}));
  with.particles.clear();
  with.label = "";
  EXPECT_EQ(look("extremes", with),
            (Values{{"atoms speed minimum", 1}, {"atoms speed maximum", 3}, {"atoms speed mean", 2}}));
}

TEST_F(Diagnoses, SimilarParticlesAreChosenAtTheFirstLookAndRemembered) {
  auto with = parameters();
  with.ensembles = {"atoms"};
  with.similar_velocity = {3, 0, 0};
  with.tolerance = 0.1;
  auto const mean_velocity = make_diagnosis("mean-velocity", with);
  EXPECT_TRUE(mean_velocity->state().empty());
  EXPECT_EQ(look(*mean_velocity).at("atoms mean velocity x"), 3);
  atoms_[0].velocity = {1, 0.5};  // slowed down, and now far from the first velocity
  atoms_[1].velocity = {3, 0};
  EXPECT_EQ(look(*mean_velocity).at("atoms mean velocity x"), 1);
  EXPECT_EQ(mean_velocity->state(), (std::vector<double>{1, 0}));
  auto const restored = make_diagnosis("mean-velocity", with);
  restored->restore(mean_velocity->state());
  EXPECT_EQ(look(*restored).at("atoms mean velocity y"), 0.5);
  restored->restore({});
  EXPECT_EQ(look(*restored).at("atoms mean velocity x"), 3);
  double const wrong[] = {2, 0};
  EXPECT_THROW(restored->restore(wrong), Error);
  with.similar_velocity = {50, 0, 0};
  EXPECT_EQ(message([&] { look("mean-velocity", with); }),
            "no particle of atoms starts within 0.1 of the velocity (50, 0)");
}

TEST_F(Diagnoses, DimensionsAreThoseOfTheQuantities) {
  auto const dimension_of = [&](char const* kind, std::size_t column, char const* quantity = "") {
    auto with = parameters();
    with.ensembles = *quantity ? std::vector<std::string>{"atoms"} : std::vector<std::string>{};
    with.quantity = quantity;
    return to_string(make_diagnosis(kind, with)->columns().at(column).dimension);
  };
  EXPECT_EQ(dimension_of("energies", 0), to_string(dimensions::energy));
  EXPECT_EQ(dimension_of("momentum", 0), to_string(dimensions::mass * dimensions::velocity));
  EXPECT_EQ(dimension_of("angular-momentum", 0), to_string(dimensions::angular_momentum));
  EXPECT_EQ(dimension_of("temperature", 0), to_string(dimensions::temperature));
  EXPECT_EQ(dimension_of("pressure", 0), to_string(dimensions::force / dimensions::length));  // in a plane
  EXPECT_EQ(dimension_of("velocity-diffusion", 0), to_string(dimensions::velocity * dimensions::velocity));
  EXPECT_EQ(dimension_of("extremes", 2, "influence.y"), to_string(dimensions::force));
  EXPECT_EQ(dimension_of("extremes", 2, "mass"), to_string(dimensions::mass));
}

/// What those two need.
void say_formula(std::string_view kind, DiagnosisParameters& with) {
  if (kind != "formula" && kind != "histogram") return;
  with.label = "one";
  with.formula = kind == "formula" ? "mean(x)" : "x";
  if (kind == "histogram") with.from = 0, with.to = 2;
}

TEST_F(Diagnoses, RefuseWhatTheyDontKnow) {
  EXPECT_EQ(
      message([&] { make_diagnosis("energy", parameters()); }),
      "there is no diagnosis 'energy'; did you mean 'energies'? There are energies, momentum, angular-momentum, "
      "vortex-invariants, vortex-energy, body-forces, temperature, pressure and 26 more (bzm list diagnoses shows "
      "all)");
  auto with = parameters();
  with.ensembles = {"atom"};
  EXPECT_EQ(message([&] { make_diagnosis("mean-velocity", with); }),
            "there is no ensemble 'atom'; there are atoms, fluid; did you mean 'atoms'?");
  EXPECT_EQ(message([&] { make_diagnosis("number", with); }),
            "there is no ensemble 'atom'; there are atoms, fluid; did you mean 'atoms'?");
  EXPECT_EQ(message([&] { make_diagnosis("pressure", with); }),
            "diagnosis pressure has no option ensembles; it has none");
  with.ensembles = {"fluid"};
  EXPECT_EQ(message([&] { make_diagnosis("temperature", with); }),
            "ensemble 'fluid' of class Tracer has no temperature: it needs a mass and a velocity");
  with.quantity = "mass";
  EXPECT_NE(message([&] { make_diagnosis("extremes", with); }).find("'fluid' of class Tracer has no quantity 'mass'"),
            std::string::npos);
  with = parameters();
  with.particles = {0};
  EXPECT_EQ(message([&] { make_diagnosis("mean-velocity", with); }),
            "a group of chosen particles belongs to one ensemble; name one of atoms, fluid");
  with.ensembles = {"atoms"};
  with.particles = {2};
  EXPECT_EQ(message([&] { make_diagnosis("mean-velocity", with); }),
            "ensemble 'atoms' has 2 particles, numbered from 0; there is no particle 2");
  with.particles = {1};
  with.similar_velocity = {0, 0, 0};
  EXPECT_THROW(make_diagnosis("mean-velocity", with), Error);
  with = parameters();
  with.subtract_drift = true;
  EXPECT_THROW(make_diagnosis("momentum", with), Error);
  EXPECT_THROW(make_diagnosis("number", {}), Error);
  EXPECT_EQ(diagnosis_kinds().size(), 34U);
  Ensemble<Smooth<2>> gas("gas");
  Ensemble<Vortex<2>> vortices("vortices");
  Ensemble<Panel<2>> body("body");
  for (auto const& kind : diagnosis_kinds()) {
    auto any = parameters();
    if (kind.of_mesh) {
      EXPECT_EQ(message([&] { make_diagnosis(kind.name, any); }), "there is no mesh in this simulation");
      continue;
    }
    if (kind.name == "body-forces") {
      EXPECT_EQ(message([&] { make_diagnosis(kind.name, any); }), "there is no body; [[bodies]] are");
      continue;
    }
    if (kind.name == "extremes") any.quantity = "speed";
    if (kind.name == "bond-order") any.range = 1;
    if (kind.name == "chains") {
      any.count = 2;
      EXPECT_EQ(message([&] { make_diagnosis(kind.name, any); }),
                "'fluid' has 1 particles, no whole number of chains of 2");
      continue;
    }
    if (kind.name == "green-kubo") any.quantity = "viscosity";
    if (kind.name == "average") any.columns_before = {{"temperature", dimensions::temperature}};
    say_formula(kind.name, any);
    if (kind.name == "entropy" || kind.name == "heat-flux") any.available = {&gas};
    if (kind.name == "heat-flux") any.conductivity = 1;
    if (kind.name == "body-forces") {
      EXPECT_EQ(message([&] { make_diagnosis(kind.name, any); }), "there is no body; [[bodies]] are");
      any.available = {&body};
    }
    if (kind.name == "vortex-invariants" || kind.of_flow) any.available = {&vortices};
    if (kind.of_flow) any.vortices = {{&vortices, BiotSavart{}}};
    std::unique_ptr<Diagnosis> made;
    ASSERT_NO_THROW(made = make_diagnosis(kind.name, any)) << kind.name;
    EXPECT_EQ(made->needs_energies() || made->needs_virial(),
              kind.name == "energies" || kind.name == "pressure" || kind.name == "viscosity" || kind.name == "shock" ||
                  kind.name == "green-kubo" || kind.name == "energy-balance");
  }
}

TEST(Diagnosis, InOneAndThreeDimensions) {
  Ensemble<Newton<1>> line("line", 1);
  Ensemble<Newton<3>> space("space", 0);
  auto const names = [](std::string const& kind, AnyEnsemble const& ensemble) {
    std::string all;
    for (auto const& column : make_diagnosis(kind, {.available = {&ensemble}})->columns()) all += column.name + ",";
    return all;
  };
  EXPECT_EQ(names("temperature", line), "temperature,");
  EXPECT_EQ(names("pressure", line), "pressure,");
  EXPECT_EQ(names("angular-momentum", line), "angular momentum,");
  EXPECT_EQ(names("angular-momentum", space), "angular momentum x,angular momentum y,angular momentum z,");
  EXPECT_EQ(names("pressure", space),
            "pressure,pressure xx,pressure xy,pressure xz,pressure yx,pressure yy,pressure yz,pressure zx,pressure zy,"
            "pressure zz,");
  EXPECT_EQ(names("mean-velocity", space), "space mean velocity x,space mean velocity y,space mean velocity z,");
  // N = 0: sums are 0, means are NaN, nothing throws.
  Box const box(Vector<3>{0, 0, 0}, Vector<3>{1, 1, 1});
  auto const measures = EnergyAndVirial::known();
  Ensemble<Smooth<3>> gas("gas");
  Ensemble<Vortex<3>> vortices("vortices");
  for (auto const& kind : diagnosis_kinds()) {
    if (kind.of_mesh || kind.name == "heat-flux") continue;     // these need a mesh, and walls of two temperatures
    if (kind.name == "slab" || kind.name == "shock") continue;  // and these, matter (see their own tests)
    if (kind.name == "body-forces") continue;                   // bodies stand in 2D
    if (kind.name == "viscosity") continue;                     // of boxes that are sheared (tests/boundaries)
    if (kind.name == "radial-distribution" || kind.name == "structure-factor" || kind.name == "mean-profile" ||
        kind.name == "average")
      continue;  // boxes without open axes, and other columns
    // An entropy belongs to matter that has an internal energy.
    AnyEnsemble* of = kind.name == "entropy" ? static_cast<AnyEnsemble*>(&gas) : &space;
    if (kind.name == "vortex-invariants" || kind.of_flow) of = &vortices;
    std::vector<AnyEnsemble*> const ensembles{of};
    DiagnosisParameters with{.available = {of}};
    if (kind.name == "extremes") with.quantity = "speed";
    if (kind.name == "bond-order") with.range = 1;
    if (kind.name == "chains") with.count = 2;
    if (kind.name == "green-kubo") with.quantity = "viscosity";
    say_formula(kind.name, with);
    if (kind.of_flow) with.vortices = {{&vortices, BiotSavart{}}};
    auto const diagnosis = make_diagnosis(kind.name, with);
    std::vector<double> values;
    diagnosis->measure({ensembles, box, &measures, 1, 0, 0}, values);
    EXPECT_EQ(values.size(), diagnosis->columns().size());
    bool const is_mean = kind.name == "temperature" || kind.name == "mean-velocity" ||
                         kind.name == "velocity-diffusion" || kind.name == "diffusion" || kind.name == "extremes" ||
                         kind.name == "entropy" || kind.name == "formula" || kind.name == "histogram" ||
                         kind.name == "velocity-autocorrelation" || kind.name == "mean-square-displacement" ||
                         kind.name == "green-kubo" || kind.name == "bond-order" || kind.name == "chains";
    for (double const value : values) EXPECT_EQ(std::isnan(value), is_mean) << kind.name;
  }
}

TEST(Derived, QuantitiesOfAClass) {
  Ensemble<Coulomb<2>> ions("ions", 2);
  ions[1].position = {3, 4};
  ions[1].velocity = {-5, 12};
  ions[1].mass = 2;
  ions[1].charge = -1;
  ions.influence(1)[1] = 0.5;
  EXPECT_EQ(quantity(ions, "position.x"), (std::vector<double>{0, 3}));
  EXPECT_EQ(quantity(ions, "velocity.y"), (std::vector<double>{0, 12}));
  EXPECT_EQ(quantity(ions, "mass"), (std::vector<double>{1, 2}));
  EXPECT_EQ(quantity(ions, "charge"), (std::vector<double>{0, -1}));
  EXPECT_EQ(quantity(ions, "speed"), (std::vector<double>{0, 13}));
  EXPECT_EQ(quantity(ions, "kinetic-energy"), (std::vector<double>{0, 169}));
  EXPECT_EQ(quantity(ions, "influence.y"), (std::vector<double>{0, 0.5}));
  EXPECT_TRUE(std::isnan(quantity(ions, "potential-energy")[0]));
  double const energies[] = {-1, -2};
  EXPECT_EQ(quantity(ions, "potential-energy", energies), (std::vector<double>{-1, -2}));
  EXPECT_EQ(quantity_meaning(ions, "kinetic-energy").label, "kinetic energy");
  EXPECT_EQ(quantity_meaning(ions, "velocity.y").label, "velocity y");
  EXPECT_EQ(quantity_meaning(ions, "velocity.y").dimension, dimensions::velocity);
  EXPECT_EQ(quantity_meaning(ions, "influence.x").dimension, dimensions::force);
  EXPECT_EQ(
      message([&] { quantity(ions, "sped"); }),
      "ensemble 'ions' of class Coulomb has no quantity 'sped'; did you mean 'speed'? It has position.x, position.y, "
      "mass, velocity.x, velocity.y, charge, influence.x, influence.y and 3 more");
  EXPECT_NE(message([&] { quantity(ions, "position"); }).find("did you mean 'position.x'?"), std::string::npos);
  EXPECT_THROW(quantity(ions, "position.z"), Error);
  EXPECT_THROW(quantity(ions, ""), Error);
}

TEST(Derived, OfFluidsAndLines) {
  Ensemble<Vortex<3>> vortices("vortices", 1);
  vortices[0].vorticity = {1, 2, 3};
  vortices.influence(0)[2] = -4;
  EXPECT_EQ(quantity(vortices, "vorticity.z")[0], 3);
  EXPECT_EQ(quantity(vortices, "velocity.z")[0], -4);
  EXPECT_EQ(quantity(vortices, "speed")[0], 4);
  EXPECT_EQ(quantity_meaning(vortices, "influence.z").dimension, dimensions::velocity);
  EXPECT_THROW(quantity(vortices, "kinetic-energy"), Error);
  Ensemble<Vortex<2>> plane("plane", 1);
  plane[0].vorticity = {7};
  EXPECT_EQ(quantity(plane, "vorticity")[0], 7);
  Ensemble<Newton<1>> line("line", 1);
  line[0].position = {6};
  EXPECT_EQ(quantity(line, "position")[0], 6);
  EXPECT_EQ(quantity(line, "position.x")[0], 6);
  EXPECT_TRUE(quantity(Ensemble<Newton<3>>("none"), "speed").empty());
}

TEST(SpectrumOf, AWaveOfVelocityHasItsWaveNumber) {
  // 240 particles on a line, velocity 0.5 sin(2 pi 6 x / L): the mean square 1/8 within the peak at 6 / L.
  constexpr std::size_t n = 240;
  Ensemble<Newton<1>> plasma("plasma", n);
  block_load(plasma, {Lattice::square, 0.25, {n, 1, 1}, {3, 0, 0}});
  double const length = n * 0.25;
  for (auto& p : plasma) p.velocity = {0.5 * std::sin(2 * pi * 6 * p.position[0] / length)};
  std::rotate(plasma.begin(), plasma.begin() + 50, plasma.end());  // the order of particles does not matter
  SpectrumOverSteps steps("velocity.x");
  for (Spectrum const& spectrum : {spectrum_of(plasma, "velocity.x"), steps.look(plasma), steps.look(plasma)}) {
    auto const peak = std::max_element(spectrum.density.begin(), spectrum.density.end()) - spectrum.density.begin();
    EXPECT_NEAR(spectrum.frequency[peak], 6 / length, spectrum.resolution / 2);
    double power = 0;
    for (double const density : spectrum.density) power += density * spectrum.resolution;
    EXPECT_NEAR(power, 0.125, 0.004);
  }
  EXPECT_THROW(spectrum_of(plasma, "velocity.x", 1), Error);
  EXPECT_THROW(spectrum_of(plasma, "velocity.z"), Error);
  EXPECT_THROW(spectrum_of(Ensemble<Newton<1>>("one", 1), "velocity.x"), Error);
  EXPECT_EQ(profile_of(plasma, "position.x", 0, 100).value.size(), 100U);
}

}  // namespace
}  // namespace boltzmann::diagnosis_catalogue_test
