// Measures of a mesh against integrals and waves known in closed form; pictures of it and the records of a run, on a
// scheme that makes its fields from a formula.
#include <boltzmann/core/error.hpp>
#include <boltzmann/diagnoses/diagnosis_catalogue.hpp>
#include <boltzmann/diagnoses/field_measures.hpp>
#include <boltzmann/diagnoses/wave_spectrum.hpp>
#include <boltzmann/files/csv.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/recording/recording.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <tests/files/temporary_folder.hpp>
#include <tests/message.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>

namespace boltzmann::field_measures_test {
namespace {

constexpr double pi = std::numbers::pi;
namespace fs = std::filesystem;

using Position = std::array<double, 3>;

/// Density, potential and field on the nodes of a mesh, from formulas.
struct Fields {
  MeshField density, potential, field;

  Fields(Box const& box, std::vector<std::size_t> const& cells) {
    MeshGrid const grid = make_grid(box, cells);
    std::vector<double> const zero(grid.size(), 0.0);
    density = {"density", dimensions::charge_density, grid, {zero}};
    potential = {"potential", dimensions::electric_potential, grid, {zero}};
    field = {"field", dimensions::electric_field, grid, {}};
    field.components.assign(static_cast<std::size_t>(box.dimension()), zero);
  }
  std::vector<MeshField const*> all() const { return {&density, &potential, &field}; }
};

void fill(MeshField& field, std::size_t component, std::function<double(Position const&)> const& f) {
  MeshGrid const& grid = field.grid;
  for (std::size_t k = 0; k < grid.nodes[2]; ++k)
    for (std::size_t j = 0; j < grid.nodes[1]; ++j)
      for (std::size_t i = 0; i < grid.nodes[0]; ++i)
        field.components[component][grid.index(i, j, k)] =
            f({grid.position(0, i), grid.position(1, j), grid.position(2, k)});
}

Box periodic_3d() { return Box(Vector{-1., 0., 2.}, Vector{3., 2., 5.}, Boundary::periodic); }

TEST(FieldEnergy, OfAPlaneWave) {
  // rho = A cos(k x) in a periodic box: phi = C A/k^2 cos(k x), E = C A/k sin(k x); (1/2 C) int E^2 = C A^2 V/(4 k^2).
  double const constant = 4 * pi, amplitude = 0.3, k = 2 * pi * 2 / 4;
  Fields fields(periodic_3d(), {16, 4, 5});
  fill(fields.density, 0, [&](Position const& x) { return amplitude * std::cos(k * (x[0] + 1) + 0.4); });
  fill(fields.potential, 0,
       [&](Position const& x) { return constant * amplitude / (k * k) * std::cos(k * (x[0] + 1) + 0.4); });
  double const exact = constant * amplitude * amplitude * 24 / (4 * k * k);
  EXPECT_NEAR(field_energy(fields.all()), exact, 1e-12 * exact);
}

TEST(FieldEnergy, BetweenConductingWalls) {
  // Uniform rho between plates at zero, a distance L apart: phi = C rho x (L - x)/2, energy C rho^2 L^3/24.
  double const length = 3, rho = 0.7, constant = 2;
  Fields fields(Box(Vector{0.}, Vector{length}, Boundary::reflecting), {300});
  fill(fields.density, 0, [&](Position const&) { return rho; });
  fill(fields.potential, 0, [&](Position const& x) { return constant * rho * x[0] * (length - x[0]) / 2; });
  double const exact = constant * rho * rho * length * length * length / 24;
  EXPECT_NEAR(field_energy(fields.all()), exact, 2e-5 * exact);
  // Where the potential is not zero at the walls, their nodes count half.
  fill(fields.potential, 0, [&](Position const&) { return 5.0; });
  EXPECT_NEAR(field_energy(fields.all()), 0.5 * rho * 5 * length, 1e-12);
}

TEST(FieldMode, AmplitudeAndPhaseOfAWave) {
  Fields fields(periodic_3d(), {16, 8, 6});
  double const kx = 2 * pi / 4, ky = 2 * pi / 2;
  fill(fields.field, 1, [&](Position const& x) {
    return 0.25 + 3 * std::cos(3 * kx * (x[0] + 1) - 2 * ky * x[1] + 0.6) + 0.5 * std::sin(kx * (x[0] + 1)) +
           0.125 * std::cos(pi * 16 / 4 * (x[0] + 1) * 1.0);  // the last changes sign from node to node
  });
  MeshQuantity const quantity = mesh_quantity(fields.all(), "field.y");
  EXPECT_EQ(quantity.label, "field y");
  auto const near = [](std::complex<double> a, std::complex<double> b) { EXPECT_LT(std::abs(a - b), 1e-13) << a << b; };
  near(field_mode(quantity, {3, -2, 0}), 3.0 * std::polar(1.0, 0.6));
  near(field_mode(quantity, {-3, 2, 0}), 3.0 * std::polar(1.0, -0.6));
  near(field_mode(quantity, {3, 2, 0}), 0);
  near(field_mode(quantity, {1, 0, 0}), {0, -0.5});
  near(field_mode(quantity, {0, 0, 0}), 0.25);
  near(field_mode(quantity, {8, 0, 0}), 0.125);
  EXPECT_NE(message([&] { field_mode(quantity, {9, 0, 0}); }).find("modes up to 8"), std::string::npos);
}

TEST(FieldMode, AxesThatAreNotPeriodicHaveTheMeanOnly) {
  Fields fields(Box(Vector{0., 0.}, Vector{4., 1.}, {Boundary::periodic, Boundary::reflecting}), {8, 10});
  fill(fields.potential, 0, [&](Position const& x) { return (1 + x[1]) * std::cos(2 * pi * x[0] / 4); });
  MeshQuantity const quantity = mesh_quantity(fields.all(), "potential");
  EXPECT_LT(std::abs(field_mode(quantity, {1, 0, 0}) - 1.5), 1e-14);
  EXPECT_EQ(message([&] {
              field_mode(quantity, {1, 2, 0});
            }),
            "mode 2 along y: the axis is not periodic; only mode 0 is possible there");
  EXPECT_EQ(message([&] { field_mode(quantity, {1, 0, 1}); }), "mode 1 along z: the mesh has no such axis");
  auto const line = profile(quantity, 1);
  ASSERT_EQ(line.size(), 11U);
  for (double const value : line) EXPECT_NEAR(value, 0, 1e-14);
}

TEST(MeshQuantity, NamesAndMistakes) {
  Fields fields(periodic_3d(), {4, 4, 4});
  EXPECT_EQ(mesh_quantities(fields.all()),
            (std::vector<std::string>{"density", "potential", "field.x", "field.y", "field.z"}));
  EXPECT_EQ(message([&] { mesh_quantity(fields.all(), "potentiel"); }),
            "the mesh has no 'potentiel'; it has density, potential, field.x, field.y, field.z; did you mean "
            "'potential'?");
  EXPECT_EQ(message([&] { mesh_quantity({}, "potential"); }), "there is no mesh in this simulation");
}

// ---- The catalogue ----

TEST(MeshDiagnoses, ColumnsAndMistakes) {
  Fields fields(periodic_3d(), {8, 8, 8});
  fill(fields.field, 0, [&](Position const& x) { return std::sin(2 * pi * (x[0] + 1) / 4); });
  DiagnosisParameters parameters;
  parameters.mesh_fields = fields.all();
  auto const energy = make_diagnosis("field-energy", parameters);
  EXPECT_TRUE(energy->needs_mesh());
  EXPECT_EQ(energy->columns()[0].name, "field energy");
  parameters.mode = {1, 0, 0};
  auto const mode = make_diagnosis("field-mode", parameters);
  std::vector<std::string> names;
  for (auto const& column : mode->columns()) {
    names.push_back(column.name);
    EXPECT_EQ(column.dimension, dimensions::electric_field);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"field x mode 1 0 0 amplitude", "field x mode 1 0 0 real",
                                             "field x mode 1 0 0 imaginary"}));
  std::vector<double> values;
  auto const all = fields.all();
  mode->measure({{}, periodic_3d(), nullptr, 1, 0, 0, all}, values);
  ASSERT_EQ(values.size(), 3U);
  EXPECT_NEAR(values[0], 1, 1e-14);
  EXPECT_NEAR(values[1], 0, 1e-14);
  EXPECT_NEAR(values[2], -1, 1e-14);
  auto const says = [&](char const* kind, DiagnosisParameters const& p) {
    return message([&] { make_diagnosis(kind, p); });
  };
  parameters.mode = {1};
  EXPECT_NE(says("field-mode", parameters).find("'mode' has 1 number, the mesh 3 axes"), std::string::npos);
  parameters.mode = {1, 0, 0};
  EXPECT_NE(says("field-energy", parameters).find("no option mode"), std::string::npos);
  parameters.mesh_fields.clear();
  EXPECT_EQ(says("field-mode", parameters), "there is no mesh in this simulation");
  parameters.mode.clear();
  EXPECT_EQ(says("field-energy", parameters), "there is no mesh in this simulation");
  EXPECT_EQ(says("wave-spectrum", parameters), "there is no mesh in this simulation");
  Fields walls(Box(Vector{0.}, Vector{1.}, Boundary::reflecting), {8});
  parameters.mesh_fields = walls.all();
  EXPECT_NE(says("wave-spectrum", parameters).find("not periodic"), std::string::npos);
  parameters.axis = "y";
  EXPECT_NE(says("wave-spectrum", parameters).find("no axis 'y'; it has x"), std::string::npos);
}

// ---- Waves ----

void look(WaveSpectrum& waves, Fields const& fields, double time) {
  auto const all = fields.all();
  std::vector<double> none;
  Box const box(Vector{0.}, Vector{4.}, Boundary::periodic);
  waves.measure({{}, box, nullptr, 1, time, 0, all}, none);
}

TEST(WaveSpectrum, FindsWavesByWaveNumberDirectionAndFrequency) {
  // Two waves on a mesh of 32 nodes, 128 looks: 3 periods to the right at 16 cycles, 5 to the left at 9.
  Box const box(Vector{0.}, Vector{4.}, Boundary::periodic);
  Fields fields(box, {32});
  WaveSpectrum waves("field.x", 0), few("field.x", 0, 4);
  double const dt = 0.05, right = 2 * pi * 16 / (128 * dt), left = 2 * pi * 9 / (128 * dt);
  for (int n = 0; n < 128; ++n) {
    fill(fields.field, 0, [&](Position const& x) {
      return 2 * std::cos(2 * pi * 3 * x[0] / 4 - right * n * dt) +
             0.5 * std::cos(2 * pi * 5 * x[0] / 4 + left * n * dt + 1);
    });
    look(waves, fields, 7 + n * dt);
    look(few, fields, 7 + n * dt);
  }
  auto const spectrum = waves.power();
  ASSERT_EQ(spectrum.wave_number.size(), 33U);
  ASSERT_EQ(spectrum.frequency.size(), 65U);
  EXPECT_NEAR(spectrum.wave_number[19], 2 * pi * 3 / 4, 1e-14);
  EXPECT_NEAR(spectrum.frequency[16], right, 1e-12);
  EXPECT_EQ(spectrum.dimension, dimensions::electric_field);
  auto const at = [&](int mode, int cycles) {
    return spectrum.power[static_cast<std::size_t>(cycles * 33 + 16 + mode)];
  };
  // Hann's window, normalised by its mean square: 2/3 of the power in the middle, 1/6 on both sides.
  EXPECT_NEAR(at(3, 16), 2.0 * 2 / 3, 1e-12);
  EXPECT_NEAR(at(3, 15), 2.0 / 6, 1e-12);
  EXPECT_NEAR(at(-5, 9), 0.125 * 2 / 3, 1e-12);
  double total = 0, elsewhere = 0;
  for (int cycles = 0; cycles <= 64; ++cycles)
    for (int mode = -16; mode <= 16; ++mode) {
      total += at(mode, cycles);
      bool const near = (mode == 3 && std::abs(cycles - 16) <= 1) || (mode == -5 && std::abs(cycles - 9) <= 1);
      if (!near) elsewhere = std::max(elsewhere, at(mode, cycles));
    }
  EXPECT_NEAR(total, 2.125, 1e-12);
  EXPECT_LT(elsewhere, 1e-20);
  auto const low = few.power();
  ASSERT_EQ(low.wave_number.size(), 9U);
  EXPECT_NEAR(low.power[16 * 9 + 4 + 3], 2.0 * 2 / 3, 1e-12);
}

TEST(WaveSpectrum, RemembersAcrossARestartAndRefusesGaps) {
  Box const box(Vector{0.}, Vector{4.}, Boundary::periodic);
  Fields fields(box, {16});
  WaveSpectrum whole("density"), first("density"), second("density");
  second.restore(first.state());
  EXPECT_EQ(second.looks(), 0U);
  for (int n = 0; n < 20; ++n) {
    fill(fields.density, 0, [&](Position const& x) { return std::cos(2 * pi * x[0] / 4 - 0.3 * n); });
    look(whole, fields, 0.1 * n);
    look(n < 11 ? first : second, fields, 0.1 * n);
    if (n == 10) second.restore(first.state());
  }
  EXPECT_EQ(whole.state(), second.state());
  EXPECT_EQ(whole.power().power, second.power().power);
  EXPECT_NE(message([&] { look(whole, fields, 2.05); }).find("intervals must be equal"), std::string::npos);
  auto broken = whole.state();
  broken.pop_back();
  EXPECT_NE(message([&] { second.restore(broken); }).find("another length"), std::string::npos);
  EXPECT_NE(message([&] { second.restore({}); }).find("another length"), std::string::npos);
  EXPECT_NE(message([] { WaveSpectrum("density").power(); }).find("4 or more samples"), std::string::npos);
}

// ---- Records and pictures ----

/// A scheme that has a mesh with a wave on it that runs to the right, and no influences.
template <int D>
class Waving final : public Scheme {
 public:
  Waving(Box const& box, std::vector<std::size_t> const& cells) : Scheme(box), fields_(box, cells) {}
  void add_influences(double time) override { time_ = time; }
  void calculate(double time) override { Scheme::calculate(time); }
  EnergyAndVirial measure(double) override { return {}; }
  double length_scale(AnyEnsemble const&) const override { return std::numeric_limits<double>::infinity(); }
  std::string explain(AnyEnsemble const&, std::size_t) const override { return ""; }
  void make_reversible(double) override {}
  std::vector<MeshField const*> mesh_fields() override {
    // The clock is a particle that flies along x from 0 with velocity 1.
    double const time = *ensembles().front()->row(0);
    double const k = 2 * pi * 3 / 4;
    fill(fields_.density, 0, [&](Position const& x) { return 3 * std::cos(k * x[0] - 5 * time); });
    fill(fields_.potential, 0, [&](Position const& x) { return 2 * std::cos(k * x[0] - 5 * time); });
    fill(fields_.field, 0, [&](Position const& x) { return 2 * k * std::sin(k * x[0] - 5 * time); });
    return fields_.all();
  }

 private:
  Fields fields_;
  double time_ = 0;
};

template <int D>
struct Flight {
  Ensemble<Coulomb<D>> clock{"clock", 1};
  Waving<D> scheme;
  Simulation simulation;

  explicit Flight(std::vector<std::size_t> const& cells) : scheme(box(), cells), simulation(scheme, 0.125) {
    scheme.add(clock);
    clock[0].velocity[0] = 1;
    simulation.integrate(clock, Method::leap_frog);
  }
  static Box box() {
    Vector<D> low{}, high;
    for (int a = 0; a < D; ++a) high[a] = 4;
    return Box(low, high, Boundary::periodic);
  }
};

void record(Recording& recording, bool with_pictures) {
  DiagnosisParameters parameters;
  recording.diagnoses(1, {"field-energy", "wave-spectrum"});
  recording.mesh(4);
  recording.checkpoint(10);
  if (!with_pictures) return;
  recording.picture({.drawing = "mesh", .file = "potential.svg"});
  recording.picture({.drawing = "mesh", .y = "field.x", .file = "field.svg"});
  recording.picture({.drawing = "wave-spectrum", .file = "waves.svg", .curves = {{5, 0.5}, {0, 1}}});
}

template <int D>
void records(std::vector<std::size_t> const& cells) {
  TemporaryFolder const folder;
  Flight<D> run(cells);
  {
    Recording recording(run.simulation, UnitSystem::reduced(), folder / "run");
    record(recording, true);
    run.simulation.run(26);
    recording.finish();
    auto const files = recording.files();
    EXPECT_NE(std::find(files.begin(), files.end(), "mesh.pvd"), files.end());
  }
  auto const table = read_csv(folder / "run/diagnoses.csv");
  ASSERT_EQ(table.header, (std::vector<std::string>{"step", "time", "field energy"}));
  // (1/2) 3 2 V <cos^2>
  for (double const energy : table.columns[2]) EXPECT_NEAR(energy, 1.5 * std::pow(4, D), 1e-10);
  std::string const index = read_text(folder / "run/mesh.pvd");
  for (int step = 0; step <= 24; step += 4) {
    std::string const name = "mesh/0000000" + std::string(step < 10 ? "0" : "") + std::to_string(step) + ".vti";
    EXPECT_NE(index.find("\" file=\"" + name + "\"/>"), std::string::npos) << name;
    EXPECT_TRUE(fs::exists(folder / ("run/" + name))) << name;
  }
  EXPECT_NE(index.find("timestep=\"1.5\" file=\"mesh/000000012.vti\""), std::string::npos);
  for (char const* file : {"potential.svg", "field.svg", "waves.svg"})
    EXPECT_GT(fs::file_size(folder / (std::string("run/") + file)), 2000U) << file;
}

TEST(MeshRecords, FramesColumnsAndPictures) {
  records<1>({16});
  records<2>({16, 5});
  records<3>({16, 4, 3});
}

TEST(MeshPictures, ShowNodesWhereTheyAre) {
  // The clock stands at 0: potential 2 cos(3 pi x/2) on nodes at 0, 0.5, ...
  Flight<1> line({8});
  auto const units = UnitSystem::reduced();
  PictureContext const context{line.simulation, units, "", 0, 0, "", {}};
  Canvas const curve = draw({.drawing = "mesh"}, context);
  ASSERT_EQ(curve.curves().size(), 1U);
  ASSERT_EQ(curve.curves()[0].x.size(), 8U);
  EXPECT_EQ(curve.curves()[0].x[3], 1.5);
  EXPECT_NEAR(curve.curves()[0].y[3], 2 * std::cos(2 * pi * 3 / 4 * 1.5), 1e-14);
  EXPECT_EQ(curve.y_axis().label, "potential");
  // A node is the middle of a cell of the picture. In 3D the slice shows the two axes it contains.
  Flight<3> cube({8, 4, 2});
  PictureContext const in_space{cube.simulation, units, "", 0, 0, "", {}};
  Canvas const above = draw({.drawing = "mesh", .y = "density"}, in_space);
  ASSERT_EQ(above.images().size(), 1U);
  auto const& image = above.images()[0];
  EXPECT_EQ(image.columns, 8);
  EXPECT_EQ(image.rows, 4);
  EXPECT_EQ(image.x0, -0.25);
  EXPECT_EQ(image.x1, 3.75);
  EXPECT_EQ(image.y0, -0.5);
  EXPECT_EQ(above.colour_bars()[0].label, "density");
  EXPECT_EQ(above.notes().back(), "slice at z = 2");
  Canvas const side = draw({.drawing = "mesh", .y = "field.x", .slice = "x", .at = 0.9}, in_space);
  EXPECT_EQ(side.images()[0].columns, 4);
  EXPECT_EQ(side.images()[0].rows, 2);
  EXPECT_EQ(side.x_axis().label, "y");
  EXPECT_EQ(side.notes().back(), "slice at x = 1");
  EXPECT_EQ(side.colour_bars()[0].label, "field x");
}

TEST(MeshPictures, WaveSpectrumWithItsCurves) {
  Box const box(Vector{0.}, Vector{4.}, Boundary::periodic);
  Fields fields(box, {32});
  WaveSpectrum waves("field.x", 0, 8);
  for (int n = 0; n < 64; ++n) {
    fill(fields.field, 0, [&](Position const& x) { return std::cos(2 * pi * 3 * x[0] / 4 - 5.0 * n * 0.125); });
    look(waves, fields, n * 0.125);
  }
  Flight<1> line({8});
  auto const units = UnitSystem::reduced();
  PictureContext const context{line.simulation, units, "", 0, 0, "", {&waves}};
  Canvas const canvas = draw({.drawing = "wave-spectrum", .curves = {{3, 0}, {4, 1}}}, context);
  auto const& image = canvas.images().at(0);
  EXPECT_EQ(image.columns, 17);
  EXPECT_EQ(image.rows, 33);
  // The brightest cell is that of the wave.
  std::uint32_t const brightest =
      image.pixels[static_cast<std::size_t>(std::lround(5.0 * 64 * 0.125 / (2 * pi)) * 17 + 11)];
  EXPECT_EQ(std::count(image.pixels.begin(), image.pixels.end(), brightest), 1);
  ASSERT_EQ(canvas.curves().size(), 2U);
  EXPECT_EQ(canvas.curves()[0].y[0], 3);
  EXPECT_NEAR(canvas.curves()[1].y[100], 4, 1e-12);  // in the middle, k = 0
  EXPECT_NE(message([&] {
              draw({.drawing = "wave-spectrum"}, {line.simulation, units, "", 0, 0, "", {}});
            }).find("needs the diagnosis wave-spectrum"),
            std::string::npos);
}

TEST(MeshRecords, ContinueAfterACheckpointToTheSameFiles) {
  TemporaryFolder const folder;
  auto const files = [&](std::string const& name) {
    std::string all = read_text(folder / (name + "/mesh.pvd")) + read_text(folder / (name + "/diagnoses.csv"));
    std::vector<std::string> frames;
    for (auto const& entry : fs::directory_iterator(folder / (name + "/mesh"))) frames.push_back(entry.path().string());
    std::sort(frames.begin(), frames.end());
    for (auto const& frame : frames) all += frame.substr(frame.rfind('/')) + read_text(frame);
    return all;
  };
  std::vector<double> waves;
  {
    Flight<1> run({16});
    Recording recording(run.simulation, UnitSystem::reduced(), folder / "whole");
    record(recording, false);
    run.simulation.run(30);
  }
  {
    Flight<1> run({16});
    Recording recording(run.simulation, UnitSystem::reduced(), folder / "parts");
    record(recording, false);
    run.simulation.run(17);
    // The power fails here: the checkpoint is that of step 10, frames after it are there already.
    fs::copy(folder / "parts", folder / "cut", fs::copy_options::recursive);
  }
  ASSERT_TRUE(fs::exists(folder / "cut/mesh/000000016.vti"));
  fs::remove(folder / "cut/mesh.pvd");
  {
    Flight<1> run({16});
    Recording recording(run.simulation, UnitSystem::reduced(), folder / "cut");
    record(recording, false);
    recording.resume();
    EXPECT_EQ(run.simulation.step(), 10);
    EXPECT_FALSE(fs::exists(folder / "cut/mesh/000000016.vti"));
    run.simulation.run(20);
  }
  EXPECT_EQ(files("whole"), files("cut"));
}

TEST(MeshRecords, NeedAMesh) {
  TemporaryFolder const folder;
  Ensemble<Coulomb<1>> ions("ions", 1);
  PairScheme scheme(Flight<1>::box(), 1);
  scheme.add(ions);
  Simulation simulation(scheme, 0.1);
  simulation.integrate(ions, Method::leap_frog);
  Recording recording(simulation, UnitSystem::reduced(), folder / "run");
  EXPECT_EQ(message([&] { recording.diagnoses(1, {"field-energy"}); }), "there is no mesh in this simulation");
  EXPECT_NE(message([&] { recording.mesh(0); }).find("every 1 or more"), std::string::npos);
  recording.picture({.drawing = "mesh"});
  EXPECT_EQ(message([&] { recording.check(); }), "there is no mesh in this simulation");
  Recording frames(simulation, UnitSystem::reduced(), folder / "run");
  frames.mesh(1);
  EXPECT_EQ(message([&] { frames.check(); }), "mesh frames can't be recorded: there is no mesh in this simulation");
  Recording waves(simulation, UnitSystem::reduced(), folder / "run");
  waves.picture({.drawing = "wave-spectrum"});
  EXPECT_NE(message([&] { waves.check(); }).find("needs the diagnosis wave-spectrum"), std::string::npos);
}

// ---- In scenarios ----

std::string scenario(std::string const& mesh, std::string const& more) {
  return "[units]\nbase = \"si\"\n[box]\nlow = [0]\nhigh = [2]\nboundary = \"periodic\"\n[run]\nstep = 0.001\nsteps = "
         "1\n" +
         mesh +
         "[[ensembles]]\nname = \"electrons\"\nclass = \"Coulomb\"\nnumber = 6400\ncharge = 1e-9\n"
         "load = { kind = \"sinusoidal\", mode = 2, amplitude = 0.1, quiet = true }\n" +
         more;
}
std::string const with_mesh = "[mesh]\nlaw = \"coulomb\"\ncells = 128\nbackground = true\nassignment = \"tsc\"\n";

TEST(MeshScenarios, MeasureTheFieldOfARipple) {
  auto const run =
      parse_scenario(scenario(with_mesh,
                              "[[diagnoses]]\nkind = \"field-energy\"\n[[diagnoses]]\nkind = \"field-mode\"\nmode = 2\n"
                              "[[diagnoses]]\nkind = \"field-mode\"\nmode = [2]\nquantity = \"potential\"\n"
                              "[[diagnoses]]\nkind = \"wave-spectrum\"\nmodes = 8\n[output]\nmesh = 1\n"
                              "[[output.pictures]]\ndrawing = \"mesh\"\ny = \"field.x\"\n"
                              "[[output.pictures]]\ndrawing = \"wave-spectrum\"\nfile = \"waves.png\"\n"
                              "curve = { frequency = \"3 1/s\", speed = 2 }\n"),
                     "test.toml");
  EXPECT_EQ(run->output.mesh, 1);
  ASSERT_EQ(run->output.pictures.size(), 2U);
  ASSERT_EQ(run->output.pictures[1].curves.size(), 1U);
  EXPECT_EQ(run->output.pictures[1].curves[0].frequency, 3);
  EXPECT_EQ(run->output.pictures[1].curves[0].speed, 2);
  auto const fields = run->schemes.front()->mesh_fields();
  std::vector<double> values;
  for (auto& diagnosis : run->diagnoses)
    diagnosis->measure({run->simulation->ensembles(), run->box(), nullptr, 1, 0, 0, fields}, values);
  // div E = 4 pi k rho with rho = rho0 (1 + 0.1 sin(kx)) and a background: E = -A cos(k x), A = 4 pi k 0.1 rho0/k.
  double const k = 2 * pi, rho = 0.1 * 6400 * 1e-9 / 2, constant = 4 * pi * 8.9875517923e9;
  double const amplitude = constant * rho / k, energy = amplitude * amplitude * 2 / (4 * constant);
  ASSERT_EQ(values.size(), 7U);
  EXPECT_NEAR(values[0], energy, 0.01 * energy);
  EXPECT_NEAR(values[1], amplitude, 0.005 * amplitude);
  EXPECT_NEAR(values[2], -amplitude, 0.005 * amplitude);
  EXPECT_NEAR(values[3], 0, 0.005 * amplitude);
  EXPECT_NEAR(values[6], -amplitude / k, 0.005 * amplitude / k);  // phi = A/k sin(k x)
}

TEST(MeshScenarios, MistakesHaveOneLine) {
  auto const says = [](std::string const& mesh, std::string const& more) {
    return message([&] { parse_scenario(scenario(mesh, more), "test.toml"); });
  };
  EXPECT_NE(says("", "[[diagnoses]]\nkind = \"field-energy\"\n")
                .find("'field-energy' needs a mesh, but the scenario has no [mesh]"),
            std::string::npos);
  EXPECT_NE(says("", "[output]\nmesh = 5\n").find("the scenario has no [mesh]"), std::string::npos);
  EXPECT_NE(says("", "[[output.pictures]]\ndrawing = \"mesh\"\n").find("the scenario has no [mesh]"),
            std::string::npos);
  EXPECT_NE(says(with_mesh, "[[output.pictures]]\ndrawing = \"mesh\"\ny = \"field.y\"\n").find("has no 'field.y'"),
            std::string::npos);
  EXPECT_NE(
      says(with_mesh, "[[output.pictures]]\ndrawing = \"wave-spectrum\"\n").find("needs the diagnosis wave-spectrum"),
      std::string::npos);
  EXPECT_NE(says(with_mesh, "[[diagnoses]]\nkind = \"field-mode\"\nmode = [1, 2]\n").find("'mode' has 2 numbers"),
            std::string::npos);
  EXPECT_NE(says(with_mesh, "[[diagnoses]]\nkind = \"field-mode\"\n").find("mode = [3]"), std::string::npos);
}

}  // namespace
}  // namespace boltzmann::field_measures_test
