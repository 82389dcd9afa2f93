// The values of a [sweep] in a document, and the document of one of its runs. Private to this module.
#pragma once

#include <boltzmann/scenario/document.hpp>
#include <boltzmann/scenario/scenario.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace boltzmann {

class Section;
struct Reading;

struct SweepValues {
  struct Key {
    std::string path;
    Place place;
    std::vector<Item> values;
  };
  std::vector<Key> keys;
  std::int64_t seeds = 1;

  std::size_t count() const { return keys.empty() ? 1 : keys.front().values.size(); }
};

/// The varied keys, and the number of seeds.
SweepValues read_sweep_values(Item const& sweep, Mistakes& mistakes);

/// Applies "--vary key=[values]" of the command line: replaces the varied keys of [sweep] and its labels.
void override_vary(Item& document, std::vector<std::string> const& assignments, Mistakes& mistakes);

/// Adds a mistake for each key that the command line has set and the sweep varies, because its value would be lost.
void refuse_varied(Item const& document, Mistakes& mistakes);

/// Converts the scenario of the sweep to that of one run: sets the values and the seed, and removes [sweep].
void choose_run(Item& document, std::size_t run, Mistakes& mistakes);

/// The document as TOML that can be read from any folder: [sweep] contains the folder of the scenario's files.
std::string sweep_text(Item document, std::string const& folder);
/// The folder in that document; empty if it is not stored.
std::string folder_of_sweep(Item const& document);

/// Reads all of [sweep] into the result.
void read_sweep(Section& document, Reading& reading);

}  // namespace boltzmann
