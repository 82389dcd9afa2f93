// The ensembles of a SmoothScheme, and the types that its source files share. Private to this module.
#pragma once

#include <boltzmann/core/in_dimension.hpp>
#include <boltzmann/schemes/smooth/smooth_point.hpp>
#include <boltzmann/schemes/smooth/smooth_scheme.hpp>

#include <limits>
#include <memory>
#include <vector>

namespace boltzmann {

/// The number of blocks of a row in SmoothTransport after SmoothFluid.
inline std::size_t transport_blocks(int dimension) {
  return in_dimension(dimension, [](auto d) {
    return (sizeof(SmoothTransport<d>) - sizeof(SmoothFluid<d>)) / sizeof(double) / row_block;
  });
}

struct SmoothScheme::Loaded {
  AnyEnsemble* ensemble;
  MaterialKernels kernels;
  std::shared_ptr<void const> material;
  std::size_t first = 0;               // number of its first particle among all
  std::vector<std::uint32_t> members;  // its rows of the sorted copy, if there are other ensembles
  MaterialTask task;
};

struct SmoothScheme::Outside {
  AnyEnsemble* ensemble;
  ExternalKernels kernels;
  std::shared_ptr<void const> law;
  bool reads_outside;

  ExternalTask task(double time) const {
    ExternalTask task;
    task.rows = ensemble->row(0);
    task.row_stride = ensemble->stride();
    task.influence = ensemble->influence(0);
    task.time = time;
    return task;
  }
};

namespace detail {

inline constexpr std::size_t particle_grain = material_grain;
inline constexpr double skin_of_range = 0.08;
inline constexpr double room_to_grow = 1.05;  // margin of lists for ranges that vary
inline constexpr double infinite = std::numeric_limits<double>::infinity();

}  // namespace detail
}  // namespace boltzmann
