# The tarball's program: the objects of bzm, with everything but libc and libm linked in.
# Their packages, whose copyright goes with the program.
set(archive_packages libhdf5-dev libaec-dev libfftw3-dev libcairo2-dev libpixman-1-dev libfontconfig-dev libfreetype-dev libpng-dev
    libbrotli-dev libexpat1-dev uuid-dev zlib1g-dev libfmt-dev libstdc++-12-dev)
if(archives_missing)
  list(JOIN archives_missing ", " archives_missing)
  add_custom_target(portable COMMAND ${CMAKE_COMMAND} -E echo "no tarball here: not found: ${archives_missing}"
                    COMMAND ${CMAKE_COMMAND} -E false)
else()
  add_executable(bzm_portable EXCLUDE_FROM_ALL $<TARGET_OBJECTS:bzm> $<TARGET_OBJECTS:described_version>
                 ${CMAKE_CURRENT_LIST_DIR}/static_fmt.cpp)
  set_target_properties(bzm_portable PROPERTIES OUTPUT_NAME bzm RUNTIME_OUTPUT_DIRECTORY portable UNITY_BUILD OFF
                        DISABLE_PRECOMPILE_HEADERS ON)
  target_link_options(bzm_portable PRIVATE -static-libgcc -static-libstdc++)
  target_link_libraries(bzm_portable PRIVATE -Wl,--start-group $<TARGET_FILE:boltzmann> ${archives} -Wl,--end-group
                        Threads::Threads ${CMAKE_DL_LIBS} m)
  add_dependencies(bzm_portable boltzmann)
  add_custom_target(portable DEPENDS bzm_portable completions)
  install(PROGRAMS $<TARGET_FILE:bzm_portable> DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT portable EXCLUDE_FROM_ALL)
  foreach(package ${archive_packages})
    if(EXISTS /usr/share/doc/${package}/copyright)
      install(FILES /usr/share/doc/${package}/copyright RENAME ${package} DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/boltzmann/linked
              COMPONENT portable EXCLUDE_FROM_ALL)
    endif()
  endforeach()
endif()
