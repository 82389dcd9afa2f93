// A dam breaks: a column of water, once the wall is taken away, runs along the floor (Martin and Moyce 1952).
// Nothing holds the water back here, whereas in the experiment the wall took time to go: its front is 0.23 in T later.
#include <boltzmann/boltzmann.hpp>

using namespace boltzmann;

// A diagnosis of one's own: the front of the water, in the experiment's units Z = z/a and T = t sqrt(2g/a).
struct Front : Diagnosis {
  double width, gravity, half_spacing;
  std::vector<std::pair<double, double>> track;

  Front(double a, double g, double half) : width(a), gravity(g), half_spacing(half) {}
  std::vector<Column> columns() const override { return {{"T", dimensions::none}, {"Z", dimensions::none}}; }
  void measure(Sample const& sample, std::vector<double>& values) override {
    double const z = extremes(quantity(*sample.ensembles[0], "position.x")).maximum + half_spacing;
    track.emplace_back(sample.time * std::sqrt(2 * gravity / width), z / width);
    values.insert(values.end(), {track.back().first, track.back().second});
  }
};

void dam_break(Program& program) {
  double const width = 1, height = 2, gravity = 1, spacing = 0.05;
  Tait const water{.reference_density = 1, .sound_speed = 20};  // ten times as fast as anything will flow

  Box box({0, 0}, {9, 3}, Boundary::mirror);
  box.open_end(1, Box::End::high);

  Ensemble<Smooth<2>> column("water");
  fill_load(column, {.spacing = spacing, .high = {width, height}, .range = 2.6 * spacing});
  for (auto& p : column) {
    double const pressure = gravity * (height - p.position[1]);
    p.density = std::pow(1 + pressure / water.stiffness(), 1 / water.gamma);
    p.mass = p.density * spacing * spacing;
  }

  SmoothScheme scheme(box, WeightShape::wendland);
  scheme.material(column, water);
  scheme.density_from(DensityFrom::continuity);  // sums would find half a density at the free surface
  scheme.artificial_viscosity({.alpha = 0.05, .beta = 0});
  scheme.external(column, UniformGravity<2>{{0, -gravity}});

  Simulation simulation(scheme, 0.6 * scheme.courant_step());
  Recording recording = program.recording(simulation);
  recording.diagnoses(10, {"energies"}).picture({.colour = "pressure"});
  auto const& front = recording.diagnose(10, Front(width, gravity, spacing / 2));
  program.run_for(recording, 5.4 / std::sqrt(2 * gravity / width));

  std::printf("   T   experiment  here\n");
  for (auto const& [t, z] : {std::pair{0.849, 1.245}, {1.602, 1.884}, {2.95, 3.728}, {3.905, 4.999}, {5.316, 6.717}})
    for (auto const& [time, here] : front.track)
      if (time >= t) {
        std::printf("%.3f    %.3f    %.3f\n", t, z, here);
        break;
      }
}

int main(int argc, char** argv) { return run_program(argc, argv, "results/dam-break-cpp", dam_break); }
