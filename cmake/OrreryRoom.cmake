# SPDX-License-Identifier: Apache-2.0
include(OrreryHeaders)

# orrery_room(<name> [DEPENDS <room>...] [LIBRARIES <foreign target>...] [FOREIGN <include prefix>...]
#                    [EXPOSED_LIBRARIES <foreign target>...] [EXPOSED <include prefix>...])
#
# One folder under src/ is one room, one target and one namespace. DEPENDS drives the linking and, written to
# rooms.txt in the build folder, the test `layering`, which reads the includes: the rule stands in one place.
# FOREIGN lists the include prefixes of the foreign libraries that this room, and no other, may include. They stay behind
# its walls: a header that includes one is neither for other rooms nor installed. EXPOSED ones may stand in any header.
function(orrery_room name)
  cmake_parse_arguments(PARSE_ARGV 1 ROOM "" "" "DEPENDS;LIBRARIES;FOREIGN;EXPOSED_LIBRARIES;EXPOSED")
  if(ROOM_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "orrery_room(${name}): what is ${ROOM_UNPARSED_ARGUMENTS}?")
  endif()
  set(folder ${CMAKE_CURRENT_SOURCE_DIR}/${name})
  file(GLOB sources CONFIGURE_DEPENDS ${folder}/*.cpp)
  file(GLOB headers CONFIGURE_DEPENDS ${folder}/*.h)
  list(REMOVE_ITEM sources ${folder}/main.cpp ${folder}/launcher.cpp)

  set(target orrery_${name})
  if(sources)
    add_library(${target} STATIC ${sources} ${headers})
    set(scope PUBLIC)
    target_link_libraries(${target} PRIVATE ${ROOM_LIBRARIES})
    target_compile_options(${target} PRIVATE ${ORRERY_WARNINGS} ${ORRERY_ARITHMETIC})
    if("hwy/" IN_LIST ROOM_EXPOSED)
      target_compile_options(${target} PRIVATE ${ORRERY_SIMD})
    endif()
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(orrery::${name} ALIAS ${target})
  target_compile_features(${target} ${scope} cxx_std_20)
  target_include_directories(${target} ${scope} $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}>
                                                $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/orrery>)
  list(TRANSFORM ROOM_DEPENDS PREPEND orrery:: OUTPUT_VARIABLE rooms)
  target_link_libraries(${target} ${scope} ${rooms} ${ROOM_EXPOSED_LIBRARIES})

  orrery_internal_headers(internal ${folder} ${ROOM_FOREIGN})
  if(internal)
    list(REMOVE_ITEM headers ${internal})
  endif()
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  install(TARGETS ${target} EXPORT orrery ARCHIVE COMPONENT development)
  install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/orrery/${name} COMPONENT development)

  set_property(GLOBAL APPEND PROPERTY ORRERY_ROOMS "${name}")
  list(JOIN ROOM_DEPENDS " " depends)
  list(JOIN ROOM_FOREIGN " " foreign)
  list(JOIN ROOM_EXPOSED " " exposed)
  set_property(GLOBAL APPEND_STRING PROPERTY ORRERY_ROOM_TABLE "${name} | ${depends} | ${foreign} | ${exposed}\n")
endfunction()

# No rounding but the one that is written: a fused operation stands in the text where one is wanted. So that pictures are
# the same bit for bit, also in programs that instantiate the installed kernel text.
set(ORRERY_ARITHMETIC -ffp-contract=off)

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
