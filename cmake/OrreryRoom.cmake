# SPDX-License-Identifier: Apache-2.0

# orrery_room(<name> [DEPENDS <room>...] [LIBRARIES <third-party target>...] [FOREIGN <include prefix>...]
#                    [EXPOSED_LIBRARIES <third-party target>...] [EXPOSED <include prefix>...] [PUBLIC <header>...])
#
# Declares a room: one folder under src/, one target, one namespace.
#
# DEPENDS rooms that it may include. Drives linking and, through rooms.txt in the build folder, the test `layering`.
# FOREIGN include prefixes of third-party libraries that only this room may include. A header that includes one is
# internal: other rooms must not include it. EXPOSED include prefixes that any header of the room may include. LIBRARIES,
# EXPOSED_LIBRARIES the targets that provide FOREIGN and EXPOSED. PUBLIC headers for other projects: they are installed,
# with the headers that they include and the rooms that they link. DECLARED only declares the room: it is no library.
function(orrery_room name)
  cmake_parse_arguments(PARSE_ARGV 1 ROOM "DECLARED" "" "DEPENDS;LIBRARIES;FOREIGN;EXPOSED_LIBRARIES;EXPOSED;PUBLIC")
  if(ROOM_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "orrery_room(${name}): unknown arguments: ${ROOM_UNPARSED_ARGUMENTS}")
  endif()
  list(JOIN ROOM_DEPENDS " " depends)
  list(JOIN ROOM_FOREIGN " " foreign)
  list(JOIN ROOM_EXPOSED " " exposed)
  set_property(GLOBAL APPEND_STRING PROPERTY ORRERY_ROOM_TABLE "${name} | ${depends} | ${foreign} | ${exposed}\n")
  if(ROOM_DECLARED)
    return()
  endif()
  set_property(GLOBAL APPEND PROPERTY ORRERY_ROOMS "${name}")
  set_property(GLOBAL APPEND PROPERTY ORRERY_FOREIGN ${ROOM_FOREIGN})
  list(TRANSFORM ROOM_PUBLIC PREPEND ${name}/)
  set_property(GLOBAL APPEND PROPERTY ORRERY_PUBLIC ${ROOM_PUBLIC})
  set(folder ${CMAKE_CURRENT_SOURCE_DIR}/${name})
  file(GLOB sources CONFIGURE_DEPENDS ${folder}/*.cpp)
  file(GLOB headers CONFIGURE_DEPENDS ${folder}/*.h)
  list(REMOVE_ITEM sources ${folder}/main.cpp ${folder}/launcher.cpp)

  set(target orrery_${name})
  if(sources)
    add_library(${target} STATIC ${sources} ${headers})
    set(scope PUBLIC)
    target_link_libraries(${target} PRIVATE ${ROOM_LIBRARIES})
    set_target_properties(${target} PROPERTIES ORRERY_LIBRARIES "${ROOM_LIBRARIES}")
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

  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} ORRERY_DEPENDS "${ROOM_DEPENDS}")
endfunction()

# orrery_instances(<room> <source> [<definition>...])
#
# Compiles a source of a room once for each of ORRERY_TARGETS, and for each definition if there are any. Its functions are
# in the namespaces of Highway's targets; ORRERY_DECLARE_INSTANCES (src/math/dispatch.h) declares them for the sources of
# the room that choose among them. More instruction sets do not recompile what is there. Function clones for constant
# arguments gain nothing here and take time to compile; so does debug information beyond lines, as long as the code.
function(orrery_instances room source)
  set(target orrery_${room})
  get_target_property(sources ${target} SOURCES)
  list(REMOVE_ITEM sources ${CMAKE_CURRENT_SOURCE_DIR}/${room}/${source})
  set_property(TARGET ${target} PROPERTY SOURCES ${sources})
  set(definitions ${ARGN})
  if(NOT definitions)
    set(definitions none)
  endif()
  cmake_path(GET source STEM name)
  foreach(isa IN LISTS ORRERY_TARGETS)
    foreach(definition IN LISTS definitions)
      string(TOLOWER ${target}_${name}_${isa}_${definition} objects)
      string(REPLACE "_none" "" objects ${objects})
      add_library(${objects} OBJECT ${room}/${source})
      set_target_properties(${objects} PROPERTIES UNITY_BUILD OFF)
      target_link_libraries(${objects} PRIVATE $<TARGET_PROPERTY:${target},LINK_LIBRARIES>)
      target_include_directories(${objects} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
      target_compile_features(${objects} PRIVATE cxx_std_20)
      target_compile_options(${objects} PRIVATE ${ORRERY_WARNINGS} ${ORRERY_ARITHMETIC} ${ORRERY_SIMD}
                             $<$<CXX_COMPILER_ID:GNU>:-fno-ipa-cp-clone> $<$<CONFIG:RelWithDebInfo>:-g1>)
      target_compile_definitions(${objects} PRIVATE HWY_COMPILE_ONLY_STATIC $<$<NOT:$<STREQUAL:${definition},none>>:ORRERY_${definition}>)
      if(NOT isa STREQUAL "STATIC")
        target_compile_definitions(${objects} PRIVATE HWY_BASELINE_TARGETS=HWY_${isa})
      endif()
      target_sources(${target} PRIVATE $<TARGET_OBJECTS:${objects}>)
    endforeach()
  endforeach()
endfunction()

# orrery_choose_instances(<room> <source>): the source of a room that chooses among the instances.
function(orrery_choose_instances room source)
  list(TRANSFORM ORRERY_TARGETS PREPEND ORRERY_ OUTPUT_VARIABLE definitions)
  set_source_files_properties(${room}/${source} PROPERTIES COMPILE_DEFINITIONS "${definitions}")
endfunction()

# The compiler must not fuse operations: the source has explicit fused operations where they are wanted.
set(ORRERY_ARITHMETIC -ffp-contract=off)

# Minimum CPU requirements: rooms with Highway code start from this instruction set. Later AVX-512 targets are disabled: they
# do not speed up this code.
set(ORRERY_SIMD "")
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(ORRERY_SIMD -march=x86-64-v2 -maes -mpclmul)
  if(HWY_VERSION VERSION_LESS 1.1)
    list(APPEND ORRERY_SIMD "-DHWY_DISABLED_TARGETS=HWY_AVX3_DL")
  else()
    list(APPEND ORRERY_SIMD "-DHWY_DISABLED_TARGETS=(HWY_AVX3_DL|HWY_AVX3_ZEN4|HWY_AVX3_SPR)")
  endif()
endif()

# ORRERY_ISAS: the instruction sets of the path loop and of traversal, of which the program uses the best that the processor
# has: `all`, `native` (the best of this machine, a third of the compilation), or some of avx512, avx2 and sse4.
# ORRERY_TARGETS: their names in Highway, best first; STATIC on other processors than x86-64.
set(ORRERY_ISAS all CACHE STRING "Instruction sets to compile for: all, native, or a list of avx512, avx2, sse4")
set(isa_names avx512 avx2 sse4)
set(all_targets AVX3 AVX2 SSE4)
set(native sse4)
if(EXISTS /proc/cpuinfo AND NOT CMAKE_CROSSCOMPILING)
  file(STRINGS /proc/cpuinfo flags REGEX "^flags" LIMIT_COUNT 1)
  if(flags MATCHES " avx2 " AND flags MATCHES " fma " AND flags MATCHES " bmi2 " AND flags MATCHES " f16c ")
    set(native avx2)
    if(flags MATCHES " avx512bw " AND flags MATCHES " avx512dq " AND flags MATCHES " avx512vl ")
      set(native avx512)
    endif()
  endif()
endif()
set(isas ${ORRERY_ISAS})
if(isas STREQUAL "all")
  set(isas ${isa_names})
elseif(isas STREQUAL "native")
  set(isas ${native})
endif()
set(ORRERY_TARGETS)
set(usable)
foreach(name target IN ZIP_LISTS isa_names all_targets)
  if(name IN_LIST isas)
    list(APPEND ORRERY_TARGETS ${target})
  endif()
  if(name STREQUAL native OR usable)
    list(APPEND usable ${target})
  endif()
endforeach()
if(NOT ORRERY_SIMD)
  set(ORRERY_TARGETS STATIC)
elseif(NOT ORRERY_TARGETS)
  message(FATAL_ERROR "ORRERY_ISAS is '${ORRERY_ISAS}': write all, native, or a list of ${isa_names}")
endif()

# Tests and benchmarks that include code of the kernel compile it for one instruction set: the best of this machine that
# the program has. Sources of tests that compare instruction sets are compiled for the others too: orrery_other_sets in
# tests/CMakeLists.txt.
set(ORRERY_ONE_SET ${ORRERY_SIMD} -DHWY_COMPILE_ONLY_STATIC)
set(ORRERY_OTHER_SETS ${ORRERY_TARGETS})
foreach(target IN LISTS ORRERY_TARGETS)
  if(target IN_LIST usable)
    list(APPEND ORRERY_ONE_SET -DHWY_BASELINE_TARGETS=HWY_${target})
    list(REMOVE_ITEM ORRERY_OTHER_SETS ${target})
    break()
  endif()
endforeach()

set(ORRERY_WARNINGS -Wall -Wextra -Wpedantic -Wshadow -Wconversion)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  list(APPEND ORRERY_WARNINGS -Wno-restrict) # GCC 12 reports overlapping copies in std::string's operator+ by mistake
endif()
if(ORRERY_WERROR)
  list(APPEND ORRERY_WARNINGS -Werror)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # These come from the optimiser and depend on what it inlines; each version reports others by mistake.
    list(APPEND ORRERY_WARNINGS -Wno-error=array-bounds -Wno-error=stringop-overflow -Wno-error=stringop-overread
                                -Wno-error=maybe-uninitialized -Wno-error=dangling-pointer)
  endif()
endif()
