# What is installed, and packages of it: Debian's (cpack -G DEB) and a tarball for other systems (cpack -G TGZ).
include(GNUInstallDirs)
include(${CMAKE_CURRENT_LIST_DIR}/describe.cmake)

if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 12)
  message(FATAL_ERROR "g++ ${CMAKE_CXX_COMPILER_VERSION} found, 12 or newer is needed (CXX=g++-12 chooses another)")
endif()

# The version with its commit, in bzm only: what is written into files says the version, so that their bits do not change with
# every commit. One small unit is compiled again when it changes.
set(described_unit ${CMAKE_CURRENT_BINARY_DIR}/described_version.cpp)
add_custom_target(describe BYPRODUCTS ${described_unit} COMMENT ""
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${CMAKE_CURRENT_SOURCE_DIR} -DVERSION=${PROJECT_VERSION} -DOUTPUT=${described_unit}
          -P ${CMAKE_CURRENT_LIST_DIR}/describe.cmake)
set_source_files_properties(${described_unit} PROPERTIES GENERATED ON SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)
add_library(described_version OBJECT EXCLUDE_FROM_ALL ${described_unit})
add_dependencies(described_version describe)
target_sources(bzm PRIVATE $<TARGET_OBJECTS:described_version>)
# Where an installed bzm finds the library.
target_compile_definitions(bzm PRIVATE BOLTZMANN_LIBRARY_FOLDER="${CMAKE_INSTALL_LIBDIR}")

# Shells complete with what the binary itself prints.
set(completions)
foreach(shell bash zsh fish)
  set(file ${CMAKE_CURRENT_BINARY_DIR}/completions/bzm.${shell})
  add_custom_command(OUTPUT ${file} DEPENDS bzm COMMENT "" COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_CURRENT_BINARY_DIR}/completions
                     COMMAND bzm completion ${shell} > ${file})
  list(APPEND completions ${file})
endforeach()
add_custom_target(completions ALL DEPENDS ${completions})
# All that `cmake --install` wants.
add_custom_target(installable DEPENDS bzm boltzmann completions)
if(BOLTZMANN_HAS_PYTHON)
  add_dependencies(installable python_module)
endif()

# What libboltzmann.a needs: Debian's packages, and the same as pkg-config's. The config files for CMake and pkg-config are made
# from this.
set(BOLTZMANN_REQUIRES fmt fftw3 cairo hdf5 zlib)
string(REPLACE ";" " " BOLTZMANN_REQUIRES_WORDS "${BOLTZMANN_REQUIRES}")
set(BOLTZMANN_DEV_PACKAGES "libfmt-dev, libfftw3-dev, libcairo2-dev, libhdf5-dev, zlib1g-dev")
include(CMakePackageConfigHelpers)
set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/boltzmann)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/boltzmann-config.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/boltzmann-config.cmake
                              INSTALL_DESTINATION ${config_folder} PATH_VARS CMAKE_INSTALL_INCLUDEDIR CMAKE_INSTALL_LIBDIR)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/boltzmann-config-version.cmake COMPATIBILITY SameMinorVersion)
file(RELATIVE_PATH BOLTZMANN_PREFIX_FROM_PKGCONFIG /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
string(REGEX REPLACE "/$" "" BOLTZMANN_PREFIX_FROM_PKGCONFIG "${BOLTZMANN_PREFIX_FROM_PKGCONFIG}")
configure_file(${CMAKE_CURRENT_LIST_DIR}/boltzmann.pc.in ${CMAKE_CURRENT_BINARY_DIR}/boltzmann.pc @ONLY)

# Installed: <prefix>/bin/bzm, lib/libboltzmann.a, include/boltzmann, share/boltzmann/scenarios, the man page. Components:
# program, data (the same in every package), library, python (in python.cmake), and portable (the tarball's program in place of program).
install(TARGETS bzm COMPONENT program)
install(TARGETS boltzmann COMPONENT library)
install(DIRECTORY boltzmann DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT library FILES_MATCHING PATTERN "*.hpp"
        PATTERN "bzm" EXCLUDE PATTERN "web" EXCLUDE PATTERN "figure_paint.hpp" EXCLUDE PATTERN "figure_text.hpp" EXCLUDE PATTERN "figure_page.hpp" EXCLUDE PATTERN "figure_plan.hpp" EXCLUDE
        PATTERN "picture_scene.hpp" EXCLUDE)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/boltzmann-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/boltzmann-config-version.cmake
        DESTINATION ${config_folder} COMPONENT library)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/boltzmann.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT library)
install(FILES packaging/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libboltzmann-dev COMPONENT library)
install(DIRECTORY scenarios DESTINATION ${CMAKE_INSTALL_DATADIR}/boltzmann COMPONENT data)
install(DIRECTORY docs/gallery DESTINATION ${CMAKE_INSTALL_DATADIR}/boltzmann COMPONENT data)
install(FILES docs/bzm.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT data)
install(FILES packaging/copyright CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/boltzmann COMPONENT data)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/completions/bzm.bash RENAME bzm
        DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT data)
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  set(zsh_functions vendor-completions)
else()
  set(zsh_functions site-functions)
endif()
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/completions/bzm.zsh RENAME _bzm
        DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/${zsh_functions} COMPONENT data)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/completions/bzm.fish
        DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT data)

describe(${CMAKE_CURRENT_SOURCE_DIR} ${PROJECT_VERSION} CPACK_PACKAGE_VERSION)
set(CPACK_PACKAGE_NAME boltzmann)
set(CPACK_PACKAGE_VENDOR "Boltzmann developers")
set(CPACK_PACKAGE_CONTACT "Boltzmann developers <boltzmann@localhost>")
set(CPACK_RESOURCE_FILE_LICENSE ${CMAKE_CURRENT_SOURCE_DIR}/LICENSE)
set(CPACK_TARBALL_NAME boltzmann-${CPACK_PACKAGE_VERSION}-linux-${CMAKE_SYSTEM_PROCESSOR})
set(CPACK_STRIP_FILES ON)
set(CPACK_THREADS 0)
set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_CURRENT_LIST_DIR}/cpack.cmake)

# Debian: boltzmann (program, data), libboltzmann-dev (library) and python3-boltzmann (python). Versions are 0.1.0+79.g1159b0a.
string(REGEX REPLACE "^([^-]*)-" "\\1+" debian_version "${CPACK_PACKAGE_VERSION}")
string(REPLACE "-" "." CPACK_DEBIAN_PACKAGE_VERSION "${debian_version}")
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_COMMAND_PACKAGE_NAME boltzmann)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SUGGESTS "libboltzmann-dev, ffmpeg")
set(CPACK_DEBIAN_COMMAND_DESCRIPTION "particle simulations from a scenario file
A scenario, a TOML file, says what the particles are, where they are, what
acts on them and what is measured: molecular dynamics, gravity, plasmas on a
mesh, smooth-particle continua, mesoparticles, vortices. bzm runs it, shows
it on a page, draws pictures and movies, and goes on after a stop to the last
bit. Kernels for AVX2 and AVX-512 are chosen when it starts.")
set(CPACK_DEBIAN_DEV_PACKAGE_NAME libboltzmann-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "${BOLTZMANN_DEV_PACKAGES}")
set(CPACK_DEBIAN_DEV_PACKAGE_RECOMMENDS "boltzmann, g++, pkg-config")
set(CPACK_DEBIAN_DEV_PACKAGE_SUGGESTS cmake)
set(CPACK_DEBIAN_DEV_DESCRIPTION "particle simulations from a C++ program: library and headers
Particle classes and laws are plain functions, compiled into vectorised
loops; with schemes, integrators, diagnoses, files and pictures. For CMake's
find_package, for pkg-config and for the command bzm build.")
set(CPACK_BOLTZMANN_PYTHON ${BOLTZMANN_HAS_PYTHON})
math(EXPR next_python "${Python_VERSION_MINOR} + 1")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-boltzmann)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "boltzmann (= ${CPACK_DEBIAN_PACKAGE_VERSION}), python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${next_python}), python3-numpy")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-matplotlib, jupyter-notebook, ffmpeg")
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA "${CMAKE_CURRENT_SOURCE_DIR}/packaging/python/postinst;${CMAKE_CURRENT_SOURCE_DIR}/packaging/python/prerm")
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "particle simulations from Python
The scenarios, laws and speed of Boltzmann with import boltzmann: particles
are arrays of numpy, measurements are tables, pictures show themselves in a
notebook; observers, sweeps, stored runs, laws by formula.")

include(${CMAKE_CURRENT_LIST_DIR}/portable.cmake)
include(CPack)
cpack_add_component_group(command)
cpack_add_component_group(dev)
cpack_add_component_group(python)
cpack_add_component(program GROUP command)
cpack_add_component(data GROUP command)
cpack_add_component(library GROUP dev)
cpack_add_component(python GROUP python)
cpack_add_component(portable)

if(BOLTZMANN_TESTS)
  add_test(NAME package_scripts COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/tests/package/scripts.sh)
  if(BOLTZMANN_HAS_PYTHON)
    set(installed_python ${Python_EXECUTABLE})
  endif()
  if(NOT BOLTZMANN_SANITIZE)  # programs of CMake and pkg-config know nothing of sanitizers
    add_test(NAME package_installed COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/tests/package/installed.sh ${CMAKE_CURRENT_BINARY_DIR} ${installed_python})
  endif()
endif()
