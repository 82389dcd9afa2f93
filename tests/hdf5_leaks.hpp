// What HDF5 can't close again of a damaged file is no leak of ours: while one of these lives, nothing is counted.
#pragma once

extern "C" {
__attribute__((weak)) void __lsan_disable();
__attribute__((weak)) void __lsan_enable();
}

namespace boltzmann {

struct DamagedHdf5 {
  DamagedHdf5() {
    if (__lsan_disable) __lsan_disable();
  }
  ~DamagedHdf5() {
    if (__lsan_enable) __lsan_enable();
  }
  DamagedHdf5(DamagedHdf5 const&) = delete;
  DamagedHdf5& operator=(DamagedHdf5 const&) = delete;
};

}  // namespace boltzmann
