// The edges of the simulation's box, as stored in files.
#pragma once

namespace boltzmann {

/// An axis-aligned box in 1 to 3 dimensions. Entries beyond `dimension` have no meaning. Edges may be infinite.
struct BoxEdges {
  int dimension = 3;
  double low[3] = {0, 0, 0}, high[3] = {1, 1, 1};
  bool periodic[3] = {false, false, false};
};

}  // namespace boltzmann
