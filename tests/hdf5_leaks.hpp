// What HDF5 can't close again of a damaged file is no leak of ours: from the first of these on nothing is counted, and
// what was leaked before it is looked for at once.
#pragma once

extern "C" {
__attribute__((weak)) void __lsan_disable();
__attribute__((weak)) void __lsan_do_leak_check();
}

namespace boltzmann {

struct DamagedHdf5 {
  DamagedHdf5() {
    if (__lsan_do_leak_check) __lsan_do_leak_check();  // the last of the process
    if (__lsan_disable) __lsan_disable();
  }
};

}  // namespace boltzmann
