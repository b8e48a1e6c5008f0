# SPDX-License-Identifier: Apache-2.0
# Finds all third-party libraries, as packaged by Debian 12 and 13. src/CMakeLists.txt assigns them to rooms.
# The installed package config includes this file too, so that projects that link orrery find the libraries in the same
# way.
include(CMakeFindDependencyMacro)

# Embree 4 if available, otherwise Embree 3.13; src/accel/embree_compat.h handles the differences. An installed orrery
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
find_dependency(LibArchive)
find_dependency(ZLIB)
find_dependency(pugixml CONFIG)
find_dependency(HDF5 COMPONENTS C)

# Debian 12 has gemmi as headers alone, Debian 13 with a library; neither has a CMake config.
if(NOT TARGET orrery::gemmi)
  find_path(ORRERY_GEMMI_INCLUDE gemmi/pdb.hpp REQUIRED)
  find_library(ORRERY_GEMMI_LIBRARY gemmi_cpp)
  add_library(orrery::gemmi INTERFACE IMPORTED)
  target_include_directories(orrery::gemmi SYSTEM INTERFACE ${ORRERY_GEMMI_INCLUDE})
  if(ORRERY_GEMMI_LIBRARY)
    target_link_libraries(orrery::gemmi INTERFACE ${ORRERY_GEMMI_LIBRARY})
  endif()
endif()

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
