// Options of a picture outside of a scenario, on a command line, as text.
#pragma once

#include <boltzmann/scenario/scenario.hpp>

#include <string>
#include <utility>
#include <vector>

namespace boltzmann {

/// Keys of picture_options() and values, as TOML or without quotation marks; a list may be without brackets.
using PictureWords = std::vector<std::pair<std::string, std::string>>;

/// The first picture of a run with the drawing and the quantities of the words (any, if they name none); else the first
/// with the drawing, without the ends of its values; else a plain picture. The words are then applied to it. `plain`:
/// the units of numbers without a unit: the base's, or those that pictures show. Throws ScenarioErrors, "--low 1 kg:
/// ...", with all errors.
enum class PlainNumbers { base, shown };
Picture picture_by_words(ScenarioSimulation const& run, PictureWords const& words,
                         PlainNumbers plain = PlainNumbers::base);

}  // namespace boltzmann
