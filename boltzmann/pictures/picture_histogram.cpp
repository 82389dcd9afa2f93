// The distribution of a quantity of the particles.
#include <boltzmann/pictures/draw_arrays.hpp>
#include <boltzmann/pictures/picture_scene.hpp>

#include <algorithm>

namespace boltzmann::pictures {
namespace {

std::string histogram_quantity(Picture const& picture, std::vector<AnyEnsemble*> const& ensembles) {
  if (!picture.x.empty()) return picture.x;
  bool const moving =
      std::any_of(ensembles.begin(), ensembles.end(), [](AnyEnsemble* e) { return has_quantity(*e, "speed"); });
  return moving ? "speed" : "position.x";
}

}  // namespace

void check_histogram(Question const& question) {
  if (!question.ensembles.empty()) question.known("x", histogram_quantity(question.picture, question.ensembles));
}

std::optional<Dimension> dimension_of_histogram(Question const& question) {
  return question.dimension(histogram_quantity(question.picture, question.ensembles));
}

Canvas draw_histogram(Scene& scene) {
  std::string const name = histogram_quantity(scene.picture, scene.ensembles);
  auto const what = meaning(scene.ensembles, name);
  auto const columns = scene.columns(name);
  std::vector<Values> values(columns.size());
  for (std::size_t e = 0; e < columns.size(); ++e) {
    values[e].resize(scene.ensembles[e]->size());
    for (std::size_t i = 0; i < values[e].size(); ++i) values[e][i] = columns[e][i];
  }
  std::vector<std::span<double const>> samples;
  std::vector<std::string> labels;
  std::vector<Colour> colours;
  for (std::size_t e = 0; e < values.size(); ++e) {
    if (!has_quantity(*scene.ensembles[e], name) || values[e].empty()) continue;
    samples.emplace_back(values[e]);
    labels.push_back(scene.ensembles.size() > 1 ? scene.ensembles[e]->name() : "");
    colours.push_back(scene.colour(e));
  }
  if (samples.empty()) return scene.too_few("a histogram of " + what.label + " needs particles; there are none");
  auto const bins = histograms(samples, static_cast<std::size_t>(scene.picture.bins.value_or(0)), scene.picture.low,
                               scene.picture.high);
  if (bins.empty()) return scene.too_few("no particle has a " + what.label + " that is a number");
  auto const unit = scene.shown_in(what.dimension);
  Axis y{unit.unit.empty() ? "probability density" : "part of the particles per " + unit.unit, ""};
  y.factor = 1 / unit.factor;
  y.logarithmic = scene.picture.logarithmic;
  std::size_t finite = 0, all = 0;
  for (std::size_t s = 0; s < samples.size(); ++s) finite += bins[s].count, all += samples[s].size();
  Canvas canvas =
      boltzmann::draw_histogram(bins, labels, colours, scene.axis(what.label, what.dimension), y, scene.title());
  if (finite < all)
    canvas.note(std::to_string(all - finite) + (all - finite == 1 ? " particle" : " particles") + " without a value");
  return canvas;
}

}  // namespace boltzmann::pictures
