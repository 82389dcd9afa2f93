// The members of a picture with their words: what run files write and read.
#pragma once

#include <boltzmann/simulation/picture.hpp>

namespace boltzmann {

/// visit(word, member) for each member of a picture (or of a const one) but its palette, which is that of a window.
template <class P, class Visit>
void each_member(P& picture, Visit const& visit) {
  visit("drawing", picture.drawing);
  visit("x", picture.x);
  visit("y", picture.y);
  visit("colour", picture.colour);
  visit("size", picture.size);
  visit("vectors", picture.vectors);
  visit("file", picture.file);
  visit("trace", picture.trace);
  visit("low", picture.low);
  visit("high", picture.high);
  visit("slice", picture.slice);
  visit("at", picture.at);
  visit("curves", picture.curves);
  visit("logarithmic", picture.logarithmic);
  visit("weight", picture.smoothing.shape);
  visit("range", picture.smoothing.range);
  visit("levels", picture.levels);
  visit("level_count", picture.level_count);
  visit("azimuth", picture.projection.azimuth);
  visit("elevation", picture.projection.elevation);
  visit("most", picture.most);
  visit("region", picture.region);
  visit("cells", picture.cells);
}

}  // namespace boltzmann
