// The words become a table of a document without a file, and are read as such.
#include <boltzmann/core/toml_text.hpp>
#include <boltzmann/diagnoses/derived.hpp>
#include <boltzmann/pictures/picture_options.hpp>
#include <boltzmann/scenario/picture_words.hpp>
#include <boltzmann/scenario/read_options.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace boltzmann {
namespace {

Item item_of(Option const& option, std::string const& text, Place const& place) {
  using Form = OptionKind::Form;
  switch (option.kind.form) {
    case Form::text:
    case Form::name:
    case Form::word:
    case Form::axis:
      return Item::of_text(text, place);
    case Form::numbers:
    case Form::count_or_numbers:
      if (text.find(',') != std::string::npos && !text.starts_with("[")) return value_of("[" + text + "]", place);
      [[fallthrough]];
    default:
      return value_of(text, place);
  }
}

/// True if it shows the quantities that the words name, if any.
bool shows(Picture plan, PictureWords const& words) {
  return std::all_of(words.begin(), words.end(), [&](auto const& word) {
    auto const& [key, text] = word;
    bool const of_quantity = key == "x" || key == "y" || key == "colour";
    return !of_quantity || toml_value(*picture_options().find(key), &plan) == toml_text(text);
  });
}

/// Plain numbers have been read as lengths; in a phase space they are in the units of its two axes.
void region_on_axes(Picture& picture, Item const& region, ScenarioSimulation const& run) {
  if (picture.drawing != "phase-space" || run.ensembles.empty()) return;
  std::string const names[2] = {picture.x.empty() ? "position.x" : picture.x,
                                picture.y.empty() ? "velocity.x" : picture.y};
  double const of_length = run.units.display(dimensions::length).factor;
  for (std::size_t a = 0; a < picture.region.size() && a < 2; ++a) {
    double const factor =
        of_length / run.units.display(quantity_meaning(*run.ensembles.front(), names[a]).dimension).factor;
    for (std::size_t end = 0; end < 2; ++end)
      if (region.elements[a].elements[end].is_number()) picture.region[a][end] *= factor;
  }
}

}  // namespace

Picture picture_by_words(ScenarioSimulation const& run, PictureWords const& words, PlainNumbers plain_numbers) {
  Mistakes mistakes("");
  ReadContext context{mistakes, run.units, ""};
  context.plain_as_shown = plain_numbers == PlainNumbers::shown;
  Item table;
  std::string drawing;
  for (auto const& [key, text] : words) {
    Place const place{0, 0, mistakes.add_override("--" + key + " " + text)};
    Option const* option = picture_options().find(key);
    if (!option) throw Error(fmt::format("a picture has no '{}'{}", key, did_you_mean(key, picture_options().keys())));
    if (key == "drawing")
      drawing = drawing_named(text).name;
    else
      table.entries.push_back({key, place, item_of(*option, text, place)});
  }
  Picture const plain;
  Picture picture;
  auto const& plans = run.output.pictures;
  auto const asked = [&](Picture const& plan) { return drawing.empty() || plan.drawing == drawing; };
  auto const same =
      std::find_if(plans.begin(), plans.end(), [&](auto const& plan) { return asked(plan) && shows(plan, words); });
  auto const like = same != plans.end() ? same : std::find_if(plans.begin(), plans.end(), asked);
  if (like != plans.end()) picture = *like;
  if (same == plans.end()) picture.low = plain.low, picture.high = plain.high;  // those of another quantity
  if (!drawing.empty()) picture.drawing = drawing;
  Section section(table, fmt::format("a picture '{}'", picture.drawing), context);
  read_options(section, drawing_named(picture.drawing).options, &picture,
               {run.box().dimension(), [&] {
                  std::vector<AnyEnsemble*> ensembles;
                  for (auto const& ensemble : run.ensembles) ensembles.push_back(ensemble.get());
                  return shown_dimension(picture, ensembles, {mesh_fields_of(run.simulation->schemes()), {}});
                }});
  section.finish();
  if (context.plain_as_shown && section.has("region")) region_on_axes(picture, *section.item("region"), run);
  check_picture_keys(section, picture, run.box().dimension(), &run.box());
  if (!mistakes.none()) throw ScenarioErrors(mistakes.lines());
  return picture;
}

}  // namespace boltzmann
