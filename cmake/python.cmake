# The Python package: build/.../python/boltzmann, a module of C++ beside plain Python. It needs pybind11-dev, and Debian's Python with
# numpy, or another one that is named: -DPython_EXECUTABLE, or an active virtual environment; never the first on the PATH.
set(BOLTZMANN_PYTHON AUTO CACHE STRING "build the Python package: ON, OFF, or AUTO, where all that it needs is there")
set_property(CACHE BOLTZMANN_PYTHON PROPERTY STRINGS AUTO ON OFF)

function(python_missing what)
  if(BOLTZMANN_PYTHON STREQUAL "ON")
    message(FATAL_ERROR "No Python package: ${what}")
  endif()
  message(STATUS "No Python package: ${what}")
endfunction()

set(BOLTZMANN_HAS_PYTHON OFF)
if(NOT BOLTZMANN_PYTHON STREQUAL "OFF" AND BOLTZMANN_SANITIZE)
  python_missing("a module with sanitizers is not loaded by an interpreter without")
elseif(NOT BOLTZMANN_PYTHON STREQUAL "OFF")
  if(NOT Python_EXECUTABLE)
    if(DEFINED ENV{VIRTUAL_ENV})
      set(Python_EXECUTABLE $ENV{VIRTUAL_ENV}/bin/python3)
    else()
      set(Python_EXECUTABLE /usr/bin/python3)
    endif()
  endif()
  find_path(PYBIND11_HEADERS pybind11/pybind11.h)
  mark_as_advanced(PYBIND11_HEADERS)
  if(NOT EXISTS ${Python_EXECUTABLE})
    python_missing("there is no ${Python_EXECUTABLE}")
  elseif(NOT PYBIND11_HEADERS)
    python_missing("it needs pybind11-dev")
  else()
    find_package(Python 3.9 COMPONENTS Interpreter Development.Module)
    execute_process(COMMAND ${Python_EXECUTABLE} -c "import numpy" RESULT_VARIABLE no_numpy ERROR_QUIET)
    if(NOT Python_FOUND)
      python_missing("${Python_EXECUTABLE} has no headers (python3-dev)")
    elseif(no_numpy)
      python_missing("${Python_EXECUTABLE} has no numpy (python3-numpy)")
    else()
      set(BOLTZMANN_HAS_PYTHON ON)
    endif()
  endif()
endif()
if(NOT BOLTZMANN_HAS_PYTHON)
  return()
endif()
message(STATUS "Python package for ${Python_EXECUTABLE} ${Python_VERSION}")

set(package ${CMAKE_CURRENT_BINARY_DIR}/python/boltzmann)
file(GLOB module_sources CONFIGURE_DEPENDS python/module/*.cpp)
Python_add_library(python_module MODULE WITH_SOABI ${module_sources})
# In two units: headers are most of what is compiled.
set_target_properties(python_module PROPERTIES OUTPUT_NAME _core LIBRARY_OUTPUT_DIRECTORY ${package} BOLTZMANN_PORTABLE ON
                      CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 4)
target_include_directories(python_module SYSTEM PRIVATE ${PYBIND11_HEADERS})
# Nothing here is an inner loop.
target_compile_options(python_module PRIVATE -Wall -Wextra -Wno-psabi $<$<CONFIG:Release,RelWithDebInfo>:-O1>)
# Shared libraries: archives are not position-independent, and h5py in the same process has its HDF5, too.
target_include_directories(python_module PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
target_link_libraries(python_module PRIVATE $<TARGET_FILE:boltzmann> fmt::fmt PkgConfig::FFTW PkgConfig::CAIRO PkgConfig::ZLIB ${HDF5_LIBRARIES} Threads::Threads ${CMAKE_DL_LIBS})
add_dependencies(python_module boltzmann)
if(BOLTZMANN_WINDOW)
  target_compile_definitions(python_module PRIVATE BOLTZMANN_WITH_WINDOW)
endif()

# What is plain Python is linked, not copied: a change is there at once.
file(GLOB package_sources CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR}/python/boltzmann python/boltzmann/*.py python/boltzmann/*.pyi python/boltzmann/py.typed)
file(MAKE_DIRECTORY ${package})
foreach(source ${package_sources})
  file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR}/python/boltzmann/${source} ${package}/${source} SYMBOLIC)
endforeach()

# `make python`: built and tried.
add_custom_target(python VERBATIM USES_TERMINAL COMMENT "" DEPENDS python_module COMMAND ${CMAKE_COMMAND} -E env PYTHONPATH=${CMAKE_CURRENT_BINARY_DIR}/python
                  ${Python_EXECUTABLE} -c "import boltzmann; sim = boltzmann.load('three-body'); print(sim.run(10))"
                  COMMAND ${CMAKE_COMMAND} -E echo export PYTHONPATH=${CMAKE_CURRENT_BINARY_DIR}/python)

# Installed where this Python looks, if that is under the prefix: /usr/local/lib/python3.11/dist-packages on Debian 12. Else, and in
# Debian's package, <prefix>/lib/python3/dist-packages. The prefix is known when it is installed.
install(CODE "execute_process(COMMAND \"${Python_EXECUTABLE}\" \"${CMAKE_CURRENT_LIST_DIR}/python_folder.py\" \"\${CMAKE_INSTALL_PREFIX}\"
                OUTPUT_VARIABLE BOLTZMANN_PYTHON_FOLDER OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)" COMPONENT python)
install(TARGETS python_module LIBRARY DESTINATION "\${BOLTZMANN_PYTHON_FOLDER}/boltzmann" COMPONENT python)
list(TRANSFORM package_sources PREPEND python/boltzmann/)
install(FILES ${package_sources} DESTINATION "\${BOLTZMANN_PYTHON_FOLDER}/boltzmann" COMPONENT python)
install(FILES packaging/copyright DESTINATION share/doc/python3-boltzmann COMPONENT python)
