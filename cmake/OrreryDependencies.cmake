# SPDX-License-Identifier: Apache-2.0
# Every foreign library, found once. Only what Debian 12 and 13 package; which room may use which is in src/CMakeLists.txt.
find_package(Threads REQUIRED)
find_package(TBB REQUIRED)
find_package(HWY CONFIG REQUIRED)
find_package(fmt CONFIG REQUIRED)
find_package(tomlplusplus CONFIG REQUIRED)
find_package(nlohmann_json CONFIG REQUIRED)
find_package(CLI11 CONFIG REQUIRED)
# Debian 12 puts this package where CMake does not look by itself.
find_package(OpenColorIO CONFIG REQUIRED PATHS /usr/share/cmake)
find_package(OpenImageIO CONFIG REQUIRED)

# Debian's packages of these two name folders of headers that are not there; CMake stops at generate for it.
function(orrery_drop_missing_includes target)
  get_target_property(dirs ${target} INTERFACE_INCLUDE_DIRECTORIES)
  set(existing)
  foreach(dir IN LISTS dirs)
    if(EXISTS "${dir}")
      list(APPEND existing "${dir}")
    endif()
  endforeach()
  set_target_properties(${target} PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${existing}")
endfunction()
orrery_drop_missing_includes(OpenImageIO::OpenImageIO)
orrery_drop_missing_includes(OpenColorIO::OpenColorIO)

# Embree 4 where there is one, else Embree 3.13; src/accel/embree_compat.h bridges the two.
find_package(embree 4 CONFIG QUIET)
if(NOT embree_FOUND)
  find_package(embree 3.13 CONFIG REQUIRED)
endif()
