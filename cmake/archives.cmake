# Libraries as archives; they come with the packages of dependencies.txt on Debian 12. A program that finds 50 shared ones whenever
# it starts takes 30 ms longer, and tests start some thousands. Packages use shared ones.
option(BOLTZMANN_ARCHIVES "link HDF5, FFTW, Cairo and what they need in, where their archives are" ON)
set(archive_names hdf5 sz aec fftw3 cairo pixman-1 fontconfig freetype png16 brotlidec brotlicommon expat uuid z)
set(archives)
set(archives_missing)
foreach(name ${archive_names})
  find_library(ARCHIVE_${name} NAMES lib${name}.a PATH_SUFFIXES hdf5/serial)
  mark_as_advanced(ARCHIVE_${name})
  if(ARCHIVE_${name})
    list(APPEND archives ${ARCHIVE_${name}})
  else()
    list(APPEND archives_missing lib${name}.a)
  endif()
endforeach()

# Under sanitizers what libraries leak is told from our leaks by the libraries' names (tests/leaks.supp).
if(BOLTZMANN_ARCHIVES AND NOT archives_missing AND NOT BOLTZMANN_SANITIZE)
  list(JOIN archives "," group)
  set(libraries "$<LINK_GROUP:RESCAN,${group}>" ${CMAKE_DL_LIBS} m)
else()
  set(libraries PkgConfig::FFTW PkgConfig::CAIRO PkgConfig::ZLIB ${HDF5_LIBRARIES})
endif()
