// Words that users wrote before and that are others now: whoever meets one in a file of then says so.
#pragma once

#include <array>
#include <string_view>

namespace boltzmann {

struct RenamedWord {
  std::string_view before, now;
};
inline constexpr std::array renamed_words{RenamedWord{"flows", "dissipation"},
                                          RenamedWord{"dissipative", "dpd"},
                                          RenamedWord{"order-free", "simultaneous"},
                                          RenamedWord{"pair-splitting", "shardlow"},
                                          RenamedWord{"prepare", "equilibrate"},
                                          RenamedWord{"bounded", "reflecting"},
                                          RenamedWord{"Euler", "Tracer"},
                                          RenamedWord{"ripple", "sinusoidal"},
                                          RenamedWord{"gravity", "barometric"},
                                          RenamedWord{"drag", "mean-velocity"},
                                          RenamedWord{"cells", "bins"},
                                          RenamedWord{"one_way", "by"}};

/// Words of other programs for what has another here.
inline constexpr std::array words_elsewhere{RenamedWord{"verlet", "leap-frog"},
                                            RenamedWord{"velocity-verlet", "leap-frog"},
                                            RenamedWord{"ias15", "gauss-radau"},
                                            RenamedWord{"yoshida", "symplectic-4"},
                                            RenamedWord{"forest-ruth", "symplectic-4"},
                                            RenamedWord{"hexagonal", "triangular"},
                                            RenamedWord{"wall", "reflecting"},
                                            RenamedWord{"dt", "step"},
                                            RenamedWord{"timestep", "step"},
                                            RenamedWord{"p3m", "accuracy"}};

}  // namespace boltzmann
