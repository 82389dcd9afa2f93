// Selects the drawing of a picture, and checks that it can be drawn.
#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/pictures/figure.hpp>
#include <boltzmann/pictures/picture_options.hpp>
#include <boltzmann/pictures/picture_scene.hpp>

#include <algorithm>

namespace boltzmann {
using namespace pictures;

namespace pictures {

void Question::on(char const* key, std::function<void()> const& check) const {
  try {
    check();
  } catch (Error const& error) {
    if (!complain) throw;
    complain(key, error.what());
  }
}

void Question::known(char const* key, std::string const& name) const {
  if (!name.empty()) on(key, [&] { meaning(ensembles, name, sources.units); });
}

void Question::need_columns(char const* key, std::vector<std::string> const& words) const {
  on(key, [&] {
    if (columns.empty()) throw Error("a picture over time needs diagnoses, and none are recorded");
    for (auto const& word : words)
      if (std::find(columns.begin(), columns.end(), word) == columns.end())
        throw Error("no diagnosis gives a column '" + word + "'" + choices(word, columns));
  });
}

void Question::need_slice() const {
  on("slice", [&] {
    if (picture.slice != "x" && picture.slice != "y" && picture.slice != "z")
      throw Error("a slice is normal to x, y or z, not '" + picture.slice + "'");
  });
}

std::optional<Dimension> Question::dimension(std::string const& name) const {
  for (auto const* ensemble : ensembles)
    if (has_quantity(*ensemble, name, sources.units)) return quantity_meaning(*ensemble, name, sources.units).dimension;
  return std::nullopt;
}

}  // namespace pictures

std::vector<std::string> vector_names(std::vector<AnyEnsemble*> const& ensembles) {
  std::vector<std::string> names;
  auto const add = [&](std::string const& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (auto const* ensemble : ensembles) {
    if (ensemble->dimension() == 1) continue;
    if (has_velocities(*ensemble)) add("velocity");
    if (ensemble->influence_size() >= static_cast<std::size_t>(ensemble->dimension())) add("influence");
    for (auto const& field : ensemble->fields())
      if (field.components == ensemble->dimension() && field.name != "position") add(field.name);
  }
  return names;
}

void check_tracks(Simulation const& simulation) {
  if (simulation.numbers_change())
    throw Error("a picture with tracks needs particles that keep their numbers; here some come and go between steps");
}

Canvas draw(Picture const& picture, PictureContext const& context) {
  auto const& drawing = drawing_named(picture.drawing);
  if (picture.trace) check_tracks(context.simulation);
  Scene scene(picture, context);
  return drawing.draw(scene);
}

void check(Picture const& picture, std::vector<AnyEnsemble*> const& ensembles, std::vector<std::string> const& columns,
           PictureSources const& sources, Complain const& complain) {
  Question const question{picture, ensembles, columns, sources, complain};
  auto const& drawing = drawing_named(picture.drawing);
  question.on("file", [&] {
    if (!ends_as_picture(picture.file))
      throw Error("the picture '" + picture.file + "' ends in none of .png, .svg, .pdf");
    if (picture.file.find('/') != std::string::npos)
      throw Error("the picture '" + picture.file + "' is a name in the run's folder, without '/'");
  });
  Picture mine = picture, plain;
  for (auto const& option : drawing.options)
    if (auto const wrong = out_of_range(option, &mine, &plain); !wrong.empty())
      question.on(option.key.c_str(), [&] { throw Error(option.key + ": " + wrong); });
  drawing.check(question);
}

std::optional<Dimension> shown_dimension(Picture const& picture, std::vector<AnyEnsemble*> const& ensembles,
                                         PictureSources const& sources) {
  auto const& drawing = drawing_named(picture.drawing);
  if (!drawing.dimension) return dimensions::none;
  return drawing.dimension({picture, ensembles, {}, sources, {}});
}

}  // namespace boltzmann
