# SPDX-License-Identifier: Apache-2.0
# Finds all third-party libraries, as packaged by Debian 12 and 13. src/CMakeLists.txt assigns them to rooms.
# The installed package config includes this file too, so that projects that link orrery find the libraries in the same
# way.
include(CMakeFindDependencyMacro)

# Embree 4 if available, otherwise Embree 3.13; src/accel/embree_api.h handles the differences. An installed orrery
# requires the version that it was built with.
if(NOT DEFINED ORRERY_EMBREE_MAJOR)
  find_package(embree 4 CONFIG QUIET)
  if(embree_FOUND)
    set(ORRERY_EMBREE_MAJOR 4)
  else()
    set(ORRERY_EMBREE_MAJOR 3.13)
  endif()
endif()
find_dependency(embree ${ORRERY_EMBREE_MAJOR} CONFIG)
find_dependency(TBB)
find_dependency(HWY CONFIG)
find_dependency(tomlplusplus CONFIG)
find_dependency(nlohmann_json CONFIG)
find_dependency(CLI11 CONFIG)
find_dependency(fmt CONFIG)
# Debian installs this config in a directory that CMake does not search.
find_dependency(OpenColorIO CONFIG PATHS /usr/share/cmake)
find_dependency(OpenImageIO CONFIG)
find_dependency(JPEG)
find_dependency(Freetype)
find_dependency(LibArchive)
find_dependency(ZLIB)
find_dependency(pugixml CONFIG)

# Libraries without a CMake config. CMake's own module for HDF5 requires the language C. Debian 12 has gemmi as headers
# alone, Debian 13 with a library.
find_path(ORRERY_HDF5_INCLUDE hdf5.h PATH_SUFFIXES hdf5/serial REQUIRED)
find_library(ORRERY_HDF5_LIBRARY NAMES hdf5_serial hdf5 REQUIRED)
find_path(ORRERY_GEMMI_INCLUDE gemmi/pdb.hpp REQUIRED)
find_library(ORRERY_GEMMI_LIBRARY gemmi_cpp)
find_path(ORRERY_MICROHTTPD_INCLUDE microhttpd.h REQUIRED)
find_library(ORRERY_MICROHTTPD_LIBRARY microhttpd REQUIRED)
foreach(name IN ITEMS HDF5 GEMMI MICROHTTPD)
  string(TOLOWER orrery::${name} target)
  if(NOT TARGET ${target})
    add_library(${target} INTERFACE IMPORTED)
    target_include_directories(${target} SYSTEM INTERFACE ${ORRERY_${name}_INCLUDE})
    if(ORRERY_${name}_LIBRARY)
      target_link_libraries(${target} INTERFACE ${ORRERY_${name}_LIBRARY})
    endif()
  endif()
endforeach()

# Debian's configs of these two list include directories that do not exist, which CMake rejects when it generates.
foreach(target IN ITEMS OpenImageIO::OpenImageIO OpenColorIO::OpenColorIO)
  get_target_property(orrery_dirs ${target} INTERFACE_INCLUDE_DIRECTORIES)
  set(orrery_existing_dirs)
  foreach(dir IN LISTS orrery_dirs)
    # Generator expressions cannot be checked yet; keep them.
    if(EXISTS "${dir}" OR dir MATCHES "^\\$<")
      list(APPEND orrery_existing_dirs "${dir}")
    endif()
  endforeach()
  set_target_properties(${target} PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${orrery_existing_dirs}")
endforeach()
