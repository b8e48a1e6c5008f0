# SPDX-License-Identifier: Apache-2.0

# orrery_room(<name> [DEPENDS <room>...] [LIBRARIES <foreign target>...] [FOREIGN <include prefix>...])
#
# One folder under src/ is one room, one target and one namespace. DEPENDS drives the linking and, written to
# rooms.txt in the build folder, the test `layering`, which greps the includes: the rule stands in one place.
# FOREIGN lists the include prefixes of the foreign libraries that this room, and no other, may include.
function(orrery_room name)
  cmake_parse_arguments(ROOM "" "" "DEPENDS;LIBRARIES;FOREIGN" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.cpp)
  list(FILTER sources EXCLUDE REGEX "/main\\.cpp$")
  set(target orrery_${name})
  if(sources)
    add_library(${target} STATIC ${sources})
    set(scope PUBLIC)
    target_compile_options(${target} PRIVATE ${ORRERY_WARNINGS} -ffp-contract=off)
    if("hwy/" IN_LIST ROOM_FOREIGN)
      target_compile_options(${target} PRIVATE ${ORRERY_SIMD})
    endif()
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(orrery::${name} ALIAS ${target})
  target_compile_features(${target} ${scope} cxx_std_20)
  target_include_directories(${target} ${scope} $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}>
                                                $<INSTALL_INTERFACE:include/orrery>)
  foreach(room IN LISTS ROOM_DEPENDS)
    target_link_libraries(${target} ${scope} orrery::${room})
  endforeach()
  target_link_libraries(${target} ${scope} ${ROOM_LIBRARIES})
  set_property(GLOBAL APPEND PROPERTY ORRERY_ROOMS "${name}")
  string(REPLACE ";" " " depends "${ROOM_DEPENDS}")
  string(REPLACE ";" " " foreign "${ROOM_FOREIGN}")
  set_property(GLOBAL APPEND_STRING PROPERTY ORRERY_ROOM_TABLE "${name} | ${depends} | ${foreign}\n")
endfunction()

# What every processor must have: rooms with per-instruction-set text start here, and dispatch upwards from it at run time.
# AVX-512's later additions are left out: they bring nothing to this code and cost a compilation each.
set(ORRERY_SIMD "")
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(ORRERY_SIMD -march=x86-64-v2 -maes -mpclmul)
  if(HWY_VERSION VERSION_LESS 1.1)
    list(APPEND ORRERY_SIMD "-DHWY_DISABLED_TARGETS=HWY_AVX3_DL")
  else()
    list(APPEND ORRERY_SIMD "-DHWY_DISABLED_TARGETS=(HWY_AVX3_DL|HWY_AVX3_ZEN4|HWY_AVX3_SPR)")
  endif()
endif()

set(ORRERY_WARNINGS -Wall -Wextra -Wpedantic -Wshadow -Wconversion)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  list(APPEND ORRERY_WARNINGS -Wno-restrict) # GCC 12 sees overlapping copies in std::string's operator+ that are not there
endif()
if(ORRERY_WERROR)
  list(APPEND ORRERY_WARNINGS -Werror)
endif()
