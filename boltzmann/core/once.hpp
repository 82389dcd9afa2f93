// Once: the result of a function, computed at the first use and kept.
#pragma once

namespace boltzmann {

template <auto make>
auto const& once() {
  static auto const made = make();
  return made;
}

}  // namespace boltzmann
