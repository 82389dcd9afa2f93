// Spectra of particles in space, and of waves over wave number and frequency.
#include <boltzmann/diagnoses/spectrum_of.hpp>
#include <boltzmann/diagnoses/wave_spectrum.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/pictures/draw_arrays.hpp>
#include <boltzmann/pictures/picture_scene.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann::pictures {
namespace {

// The recorded wave spectrum of a quantity; default: the first one.
WaveSpectrum const& recorded_waves(std::vector<Diagnosis const*> const& diagnoses, std::string const& quantity) {
  std::vector<std::string> recorded;
  for (auto const* diagnosis : diagnoses)
    if (auto const* waves = dynamic_cast<WaveSpectrum const*>(diagnosis)) {
      if (quantity.empty() || waves->quantity() == quantity) return *waves;
      recorded.push_back(waves->quantity());
    }
  if (!recorded.empty())
    throw Error("no diagnosis wave-spectrum records '" + quantity + "'" + choices(quantity, recorded, "recorded is"));
  throw Error("a picture of the wave spectrum needs the diagnosis wave-spectrum, and is drawn when the run ends");
}

void check_spectrum_axis(std::string const& x) {
  if (!x.starts_with("position."))
    throw Error("a spectrum is over position.x, position.y, position.z or time, not '" + x + "'");
}

Canvas draw_spectrum_in_space(Scene& scene) {
  std::string const x = scene.picture.x.empty() ? "position.x" : scene.picture.x;
  std::string const y = scene.picture.y.empty() ? "velocity.x" : scene.picture.y;
  auto const mx = meaning(scene.ensembles, x), my = meaning(scene.ensembles, y);
  check_spectrum_axis(x);
  scene.need(y);
  for (auto const* ensemble : scene.ensembles) {
    if (!has_quantity(*ensemble, y)) continue;
    auto const spectrum = spectrum_of(*ensemble, y, x.back() - 'x');
    return boltzmann::draw_spectrum(
        spectrum.frequency, spectrum.density, scene.axis("wave number / 2π", dimensions::none / mx.dimension),
        scene.axis("power of " + my.label, my.dimension * my.dimension * mx.dimension), true, scene.title());
  }
  throw Error("no particles with '" + y + "' to draw a spectrum of");
}

}  // namespace

Canvas draw_spectrum(Scene& scene) {
  return scene.picture.x == "time" ? draw_spectrum_in_time(scene) : draw_spectrum_in_space(scene);
}

void check_spectrum(Question const& question) {
  if (question.picture.x == "time") return question.need_columns("y", split_words(question.picture.y, ','));
  if (!question.picture.x.empty())
    question.on("x", [&] {
      check_spectrum_axis(question.picture.x);
      meaning(question.ensembles, question.picture.x);
    });
  question.known("y", question.picture.y);
}

void check_waves(Question const& question) {
  question.on("y", [&] { recorded_waves(question.sources.diagnoses, question.picture.y); });
}

// Power over wave number and frequency; colours by its logarithm, over six decades.
Canvas draw_wave_spectrum(Scene& scene) {
  WaveSpectrum const& waves = recorded_waves(scene.context.diagnoses, scene.picture.y);
  if (!waves.enough())
    return scene.too_few(fmt::format("a wave spectrum needs 4 or more samples, not {}", waves.looks()));
  WavePower const spectrum = waves.power();
  auto const& k = spectrum.wave_number;
  auto const& omega = spectrum.frequency;
  double largest = 0;
  for (double const p : spectrum.power) largest = std::max(largest, p);
  Values decades;
  for (double const p : spectrum.power)
    decades.push_back(largest > 0 ? std::max(-6.0, std::log10(p / largest)) : no_value);
  double const dk = k.size() > 1 ? k[1] - k[0] : 1, half = 0.5 * omega[1];
  Axis x = scene.axis(std::string("wave number k_{") + "xyz"[waves.axis()] + "}", dimensions::wave_number);
  Axis y = scene.axis("ω", dimensions::frequency);
  x.low = k.front() - 0.5 * dk, x.high = k.back() + 0.5 * dk;
  y.low = -half, y.high = omega.back() + half;
  std::string label = waves.quantity();
  if (auto const dot = label.rfind('.'); dot != std::string::npos) label[dot] = ' ';
  Canvas canvas =
      draw_field(static_cast<int>(k.size()), static_cast<int>(omega.size()), decades, x, y,
                 "log_{10} power of " + label + ", the largest is 0", "", ColourMap::viridis, scene.title(false));
  canvas.equal_aspect(false);
  for (auto const& dispersion : scene.picture.curves) {
    Values right, up;
    for (int i = 0; i <= 200; ++i) {
      double const at = x.low + (x.high - x.low) * i / 200;
      double const frequency = std::hypot(dispersion.frequency, dispersion.speed * at);
      right.push_back(at);
      up.push_back(frequency <= y.high ? frequency : no_value);
    }
    canvas.curve(right, up, colour_named("white"), "", 2, true);
  }
  return canvas;
}

}  // namespace boltzmann::pictures
