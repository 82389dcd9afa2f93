// RestoredInfluences: what a scheme is besides that counts its calculations in its state.
#pragma once

namespace boltzmann {

/// A checkpoint may hold influences, which a run that goes on then does not calculate again.
class RestoredInfluences {
 public:
  /// Called after Scheme::restore() if it does.
  virtual void influences_restored() = 0;

 protected:
  ~RestoredInfluences() = default;
};

}  // namespace boltzmann
