# libboltzmann_mpi.so, by which processes do one run: made by the mpicc that there is, beside bzm. Nothing links it; where there is
# no MPI nothing else changes. Its source is installed, so that every machine can make it with an MPI of its own.
include(GNUInstallDirs)
set(mpi_source ${CMAKE_CURRENT_SOURCE_DIR}/boltzmann/core/mpi_plugin.c)
set(mpi_functions ${CMAKE_CURRENT_SOURCE_DIR}/boltzmann/core/team_functions.h)
install(FILES ${mpi_source} ${mpi_functions} DESTINATION ${CMAKE_INSTALL_DATADIR}/boltzmann/mpi COMPONENT data)

find_program(MPICC mpicc)
if(MPICC)
  execute_process(COMMAND ${MPICC} -fsyntax-only ${mpi_source} RESULT_VARIABLE mpicc_fails OUTPUT_QUIET ERROR_QUIET)
  if(mpicc_fails)
    message(STATUS "No plug-in for MPI: ${MPICC} does not compile it")
  else()
    set(mpi_plugin ${CMAKE_CURRENT_BINARY_DIR}/libboltzmann_mpi.so)
    add_custom_command(OUTPUT ${mpi_plugin} DEPENDS ${mpi_source} ${mpi_functions} COMMENT "MPI plug-in"
                       COMMAND ${MPICC} -std=c99 -Wall -Wextra -O2 -shared -fPIC ${mpi_source} -o ${mpi_plugin})
    add_custom_target(mpi_plugin ALL DEPENDS ${mpi_plugin})
    add_dependencies(bzm mpi_plugin)
    install(PROGRAMS ${mpi_plugin} DESTINATION lib/boltzmann COMPONENT mpi)
  endif()
endif()
