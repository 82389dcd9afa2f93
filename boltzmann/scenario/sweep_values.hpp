// The values of a [sweep] as they stand in a document, and the document of one of its runs. Private to this room.
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

/// What varies, and how many seeds there are.
SweepValues read_sweep_values(Item const& sweep, Mistakes& mistakes);

/// What "--vary key=[values]" of the command line puts into [sweep] instead of what varies there, and of its labels.
void override_vary(Item& document, std::vector<std::string> const& assignments, Mistakes& mistakes);

/// A mistake for each key that the command line has set and the sweep varies: its value would be lost.
void refuse_varied(Item const& document, Mistakes& mistakes);

/// Makes the scenario of one run out of that of the sweep: the values stand where they belong, the seed is counted up,
/// and there is no [sweep] any more.
void choose_run(Item& document, std::size_t run, Mistakes& mistakes);

/// The document as TOML that can be read from any folder: [sweep] knows where the scenario's files are.
std::string sweep_text(Item document, std::string const& folder);
/// That folder; empty if it is not told.
std::string folder_of_sweep(Item const& document);

/// Reads all of [sweep] into the result.
void read_sweep(Section& document, Reading& reading);

}  // namespace boltzmann
