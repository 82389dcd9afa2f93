// Two galaxies, discs of stars in halos of dark matter, fall towards each other on a parabola and pass; their tides
// draw bridges and tails out of the discs.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

constexpr double halo_radius = 0.5;  // G = 1, and each galaxy has the mass 1

/// A thin disc of light stars on circles in the field of the halo: v^2 / r = r / (r^2 + a^2)^(3/2).
void disc_load(Ensemble<Kepler<3>>& disc, Vector<3> centre, Vector<3> drift, std::uint64_t seed) {
  auto const round = [](double const* x) { return x[0] * x[0] + x[1] * x[1] < 1.5 * 1.5; };
  random_load(disc, Box({-1.5, -1.5, -0.02}, {1.5, 1.5, 0.02}), {.seed = seed, .where = round});
  for (auto& p : disc) {
    Vector const r = p.position;
    double const rate = std::pow(r[0] * r[0] + r[1] * r[1] + halo_radius * halo_radius, -0.75);
    p.mass = 1e-7;
    p.position = centre + r;
    p.velocity = drift + Vector{-r[1], r[0], 0.0} * rate;
  }
  disc.appearance.diameter = 0.05;
}

void galaxies(Program& program) {
  double const x = 1.8, y = 2.4, u = 0.365148, v = 0.182574;  // points would be 1.2 apart at their nearest
  Ensemble<Kepler<3>> west("west halo", 4000), east("east halo", 4000), west_disc("west disc", 1000),
      east_disc("east disc", 1000);
  PlummerOptions halo{
      .mass = 1, .radius = halo_radius, .centre = {-x, -y, 0}, .drift = {u, v, 0}, .seed = program.seed()};
  plummer_load(west, halo);
  halo.centre = {x, y, 0}, halo.drift = {-u, -v, 0};
  plummer_load(east, halo);
  disc_load(west_disc, {-x, -y, 0.0}, {u, v, 0.0}, program.seed());
  disc_load(east_disc, {x, y, 0.0}, {-u, -v, 0.0}, program.seed());
  west.appearance.diameter = east.appearance.diameter = 0.01;

  MultipoleScheme scheme(Box({-2.6, -2.6, -1.3}, {2.6, 2.6, 1.3}), gravity(1, 0.02), 5e-3);
  for (auto* ensemble : {&west, &east, &west_disc, &east_disc}) scheme.add(*ensemble);
  Simulation simulation(scheme, 0.04);
  double nearest = 6, time = 0;
  simulation.observe(1, [&](Simulation const& s) {
    auto const place = [](auto const& p) { return p.position; };
    double const apart = magnitude(mean(west, place) - mean(east, place));
    if (apart < nearest) nearest = apart, time = s.time();
  });

  Recording recording = program.recording(simulation);
  recording.diagnoses(5, {"energies", "momentum", "angular-momentum"}).trajectory(10);
  recording.picture({.projection = {.azimuth = -90, .elevation = 90}});
  program.run_for(recording, 10);
  std::printf("nearest at %.2f, %.3f apart; rigid spheres would be at 6.09, 1.381 apart\n", time, nearest);
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/galaxies-cpp", galaxies); }
