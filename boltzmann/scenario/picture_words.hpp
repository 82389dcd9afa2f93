// What is said of a picture outside of a scenario, on a command line: option by option, as text.
#pragma once

#include <boltzmann/scenario/scenario.hpp>

#include <string>
#include <utility>
#include <vector>

namespace boltzmann {

/// Keys of picture_options() and values, as TOML or without its quotation marks; a list may be without brackets.
using PictureWords = std::vector<std::pair<std::string, std::string>>;

/// The first picture of a run that has the drawing and the quantities which the words ask for (any, if they ask for none),
/// else the first with the drawing, but for the ends of its values, with what they say of it; a plain one if the run has
/// none. `plain`: what numbers without a unit count: the base's units, or those that pictures show.
/// ScenarioErrors, "--low 1 kg: ...", with all that is wrong.
enum class PlainNumbers { base, shown };
Picture picture_by_words(ScenarioSimulation const& run, PictureWords const& words,
                         PlainNumbers plain = PlainNumbers::base);

}  // namespace boltzmann
