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

# Debian 12 names a folder of headers in this target that its package does not bring; CMake stops at generate for it.
get_target_property(oiio_include_dirs OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
if(oiio_include_dirs)
  set(oiio_existing_dirs)
  foreach(dir IN LISTS oiio_include_dirs)
    if(EXISTS "${dir}")
      list(APPEND oiio_existing_dirs "${dir}")
    endif()
  endforeach()
  set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${oiio_existing_dirs}")
endif()

# Embree 4 where there is one, else Embree 3.13; src/accel/embree_compat.h bridges the two.
find_package(embree 4 CONFIG QUIET)
if(NOT embree_FOUND)
  find_package(embree 3.13 CONFIG REQUIRED)
endif()
