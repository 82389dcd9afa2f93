// Once: what a function makes, made when it is first asked for and kept.
#pragma once

namespace boltzmann {

template <auto make>
auto const& once() {
  static auto const made = make();
  return made;
}

}  // namespace boltzmann
