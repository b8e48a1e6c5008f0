# SPDX-License-Identifier: Apache-2.0
# Every foreign library, found once, as Debian 12 and 13 package it. Which room may use which stands in src/CMakeLists.txt.
# The installed package config includes this file too, so that whoever links orrery finds the libraries in the same way.
include(CMakeFindDependencyMacro)

# Embree 4 where there is one, else Embree 3.13; src/accel/embree_compat.h bridges the two. An installed orrery asks for
# the one that it was built with.
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
# Debian puts this package where CMake does not look by itself.
find_dependency(OpenColorIO CONFIG PATHS /usr/share/cmake)
find_dependency(OpenImageIO CONFIG)
find_dependency(JPEG)

# Debian's packages of these two name folders of headers that are not there; CMake stops at generate for it.
foreach(target IN ITEMS OpenImageIO::OpenImageIO OpenColorIO::OpenColorIO)
  get_target_property(orrery_dirs ${target} INTERFACE_INCLUDE_DIRECTORIES)
  set(orrery_existing_dirs)
  foreach(dir IN LISTS orrery_dirs)
    # A generator expression cannot be looked at yet; it stays.
    if(EXISTS "${dir}" OR dir MATCHES "^\\$<")
      list(APPEND orrery_existing_dirs "${dir}")
    endif()
  endforeach()
  set_target_properties(${target} PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${orrery_existing_dirs}")
endforeach()
