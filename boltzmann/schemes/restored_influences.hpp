// RestoredInfluences: an interface of schemes that count calculations in their state.
#pragma once

namespace boltzmann {

/// A checkpoint may contain influences. A resumed run then does not calculate them again.
class RestoredInfluences {
 public:
  /// Called after Scheme::restore() in that case.
  virtual void influences_restored() = 0;

 protected:
  ~RestoredInfluences() = default;
};

}  // namespace boltzmann
