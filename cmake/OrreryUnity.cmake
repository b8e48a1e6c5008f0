# SPDX-License-Identifier: Apache-2.0
# Excludes sources with Highway code from unity builds: each is compiled once per instruction set and cannot share a
# translation unit. Include this after all targets are defined.
#
# With CMAKE_UNITY_BUILD=ON, as run.sh and test.sh configure, everything is compiled in half the time. Developers build
# without it: changes are compiled faster, and missing includes are found.
function(orrery_exclude_highway_from_unity directory)
  get_property(targets DIRECTORY ${directory} PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target IN LISTS targets)
    get_target_property(folder ${target} SOURCE_DIR)
    get_target_property(sources ${target} SOURCES)
    list(FILTER sources INCLUDE REGEX "\\.cpp$")
    foreach(source IN LISTS sources)
      cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${folder})
      file(STRINGS ${source} highway REGEX "^#include <hwy/foreach_target.h>" LIMIT_COUNT 1)
      if(highway)
        set_source_files_properties(${source} TARGET_DIRECTORY ${target} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
      endif()
    endforeach()
  endforeach()
  get_property(children DIRECTORY ${directory} PROPERTY SUBDIRECTORIES)
  foreach(child IN LISTS children)
    orrery_exclude_highway_from_unity(${child})
  endforeach()
endfunction()

if(CMAKE_UNITY_BUILD)
  orrery_exclude_highway_from_unity(${PROJECT_SOURCE_DIR})
endif()
