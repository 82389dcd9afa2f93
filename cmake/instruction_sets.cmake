# Which instruction sets the kernels are compiled for, and the units that hold them.
#   all        plain x86-64, AVX2 (v3) and AVX-512 (v4): what is packaged and tested runs on any x86-64
#   machine    the best set of this machine alone: what `make run` builds, in half the time
#   native     everything, not only kernels, for BOLTZMANN_ARCH: other processors, other build types, sanitizers
# or a list of x86_64;x86_64_v3;x86_64_v4. Ordinary units are plain x86-64 with any of them but `native`, so that their bits don't
# depend on the choice. Only with full optimisation do kernel units leave nothing behind that other units could get.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$" AND CMAKE_BUILD_TYPE STREQUAL "Release" AND NOT BOLTZMANN_SANITIZE)
  set(BOLTZMANN_SETS all CACHE STRING "instruction sets of the kernels: all, machine, native or a list of x86_64;x86_64_v3;x86_64_v4")
else()
  set(BOLTZMANN_SETS native)
endif()

set(flags_x86_64 -march=x86-64)
set(flags_x86_64_v3 -march=x86-64-v3)
set(flags_x86_64_v4 -march=x86-64-v4 -mprefer-vector-width=512)
set(flags_native -march=${BOLTZMANN_ARCH})

if(BOLTZMANN_SETS STREQUAL "all")
  set(kernel_sets x86_64 x86_64_v3 x86_64_v4)
elseif(BOLTZMANN_SETS STREQUAL "machine")
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} -march=native -dM -E -x c++ /dev/null OUTPUT_VARIABLE macros)
  set(kernel_sets x86_64)
  if(macros MATCHES "__AVX2__" AND macros MATCHES "__FMA__" AND macros MATCHES "__BMI2__" AND macros MATCHES "__F16C__" AND macros MATCHES "__MOVBE__")
    set(kernel_sets x86_64_v3)
    if(macros MATCHES "__AVX512BW__" AND macros MATCHES "__AVX512CD__" AND macros MATCHES "__AVX512DQ__" AND macros MATCHES "__AVX512VL__")
      set(kernel_sets x86_64_v4)
    endif()
  endif()
else()
  set(kernel_sets ${BOLTZMANN_SETS})
endif()
foreach(set ${kernel_sets})
  if(NOT DEFINED flags_${set})
    message(FATAL_ERROR "BOLTZMANN_SETS has '${set}'; it is all, machine, native or a list of x86_64, x86_64_v3 and x86_64_v4")
  endif()
endforeach()
message(STATUS "Instruction sets of the kernels: ${kernel_sets}")

# core/kernel_unit.hpp and the choice at run time read which sets there are.
list(TRANSFORM kernel_sets PREPEND "InstructionSet::" OUTPUT_VARIABLE kernel_set_names)
list(JOIN kernel_set_names ", " kernel_set_names)
set(generated ${CMAKE_CURRENT_BINARY_DIR}/generated)
configure_file(cmake/kernel_sets.hpp.in ${generated}/kernel_sets.hpp @ONLY)

# add_kernels(target source...) adds the sources, once for every set, to the target.
function(add_kernels target)
  foreach(set ${kernel_sets})
    add_library(kernels_${set} OBJECT ${ARGN})
    loadable(kernels_${set})
    target_include_directories(kernels_${set} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} ${generated})
    target_compile_definitions(kernels_${set} PRIVATE BOLTZMANN_INSTRUCTION_SET=${set})
    target_compile_options(kernels_${set} PRIVATE ${flags_${set}} -Wno-psabi -Wall -Wextra)
    if(BOLTZMANN_SANITIZE)
      target_compile_options(kernels_${set} PRIVATE -fsanitize=${BOLTZMANN_SANITIZE} -fno-omit-frame-pointer)
    endif()
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:kernels_${set}>)
  endforeach()
endfunction()
