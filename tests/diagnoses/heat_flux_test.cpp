// Heat flux between walls: by hand, and what is refused.
#include <boltzmann/diagnoses/diagnosis_catalogue.hpp>
#include <boltzmann/diagnoses/heat_flux.hpp>
#include <boltzmann/particles/smooth.hpp>

#include <tests/message.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace boltzmann::heat_flux_test {
namespace {

struct Layer {
  Box box{Vector{0.0, 0.0}, Vector{2.0, 4.0}, {Boundary::periodic, Boundary::mirror}};
  Ensemble<Smooth<2>> fluid{"fluid", 2};
  std::vector<AnyEnsemble*> all{&fluid};
  std::vector<AnyEnsemble const*> available{&fluid};

  Layer() {
    box.wall(1, Box::End::low, {.temperature = 3});
    box.wall(1, Box::End::high, {.temperature = 1});
    for (auto& p : fluid) {
      p.mass = 2;
      p.density = 4;
    }
    // Enthalpies 5 + 8/4 = 7 and 2 + 4/4 = 3; the mean is 5.
    fluid[0].specific_energy = 5;
    fluid[0].pressure = 8;
    fluid[0].velocity = {9, 1.5};
    fluid[1].specific_energy = 2;
    fluid[1].pressure = 4;
    fluid[1].velocity = {9, -0.5};
  }
  std::vector<double> look(HeatFlux& flux, double time = 0) {
    std::vector<double> values;
    flux.measure(Sample{all, box, nullptr, 1, time, 0}, values);
    return values;
  }
};

TEST(HeatFlux, ByHand) {
  Layer layer;
  HeatFlux flux(layer.available, {.axis = 1, .conductivity = 0.5, .since = 1});
  ASSERT_EQ(flux.columns().size(), 5U);
  EXPECT_EQ(flux.columns()[2].name, "nusselt number");
  auto values = layer.look(flux);
  EXPECT_DOUBLE_EQ(values[0], 0.5 * 2 / 4);
  EXPECT_DOUBLE_EQ(values[1], (2 * 1.5 * 2 + 2 * -0.5 * -2) / 8);
  EXPECT_DOUBLE_EQ(values[2], 1 + 1 / 0.25);
  EXPECT_TRUE(std::isnan(values[3]) && std::isnan(values[4]));  // before `since`
  // A drift of everything carries nothing.
  for (auto& p : layer.fluid) p.velocity[1] += 10;
  EXPECT_DOUBLE_EQ(layer.look(flux, 1)[2], 5);
  for (auto& p : layer.fluid) p.velocity[1] = 0;
  values = layer.look(flux, 2);
  EXPECT_DOUBLE_EQ(values[2], 1);
  EXPECT_DOUBLE_EQ(values[3], 3);  // of 5 and 1
  EXPECT_DOUBLE_EQ(values[4], 2);

  HeatFlux other(layer.available, {.axis = 1, .conductivity = 0.5, .since = 1});
  other.restore(flux.state());
  EXPECT_EQ(layer.look(other, 3), layer.look(flux, 3));
  EXPECT_EQ(message([&] { other.restore({}); }),
            "the checkpoint does not fit this diagnosis: a heat flux remembers three numbers");
}

TEST(HeatFlux, Refusals) {
  Layer layer;
  EXPECT_EQ(message([&] { HeatFlux(layer.available, {.axis = 1}); }),
            "a heat flux needs the conductivity of the material, above 0; it is 0");
  EXPECT_EQ(message([&] { HeatFlux(layer.available, {.axis = 2, .conductivity = 1}); }),
            "a heat flux along axis z: the space has 2 axes");
  EXPECT_EQ(message([] { HeatFlux({}, {.axis = 0, .conductivity = 1}); }),
            "a heat flux needs smooth particles; the simulation has none");
  Ensemble<Newton<2>> atoms("atoms", 1);
  EXPECT_EQ(message([&] { HeatFlux({&atoms}, {.axis = 0, .conductivity = 1}); }),
            "ensemble 'atoms' of class Newton carries no heat: it has no specific_energy");
  HeatFlux across(layer.available, {.axis = 0, .conductivity = 1});
  EXPECT_EQ(message([&] { layer.look(across); }),
            "a heat flux along x needs walls of different temperatures at both ends of this axis");
  layer.box.wall(1, Box::End::high, {.temperature = 3});
  HeatFlux level(layer.available, {.axis = 1, .conductivity = 1});
  EXPECT_EQ(message([&] { layer.look(level); }),
            "a heat flux along y needs walls of different temperatures at both ends of this axis");
}

TEST(HeatFlux, IsInTheCatalogue) {
  Layer layer;
  DiagnosisParameters parameters;
  parameters.available = layer.available;
  parameters.conductivity = 0.5;
  auto const flux = make_diagnosis("heat-flux", parameters);  // across the last axis
  std::vector<double> values;
  flux->measure(Sample{layer.all, layer.box, nullptr, 1, 0, 0}, values);
  EXPECT_DOUBLE_EQ(values[2], 5);
  parameters.axis = "x";
  EXPECT_NO_THROW(make_diagnosis("heat-flux", parameters));
  parameters = {};
  parameters.available = layer.available;
  parameters.since = 1;
  EXPECT_EQ(message([&] { make_diagnosis("momentum", parameters); }),
            "diagnosis momentum has no option since; it has ensembles");
}

}  // namespace
}  // namespace boltzmann::heat_flux_test
