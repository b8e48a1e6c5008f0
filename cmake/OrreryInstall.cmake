# SPDX-License-Identifier: Apache-2.0
# Installation, the package config for find_package(orrery), and the Debian packages of `cpack -G DEB`: orrery (the
# program) and orrery-dev (the rooms as static libraries, with headers).
include(CMakePackageConfigHelpers)
include(OrreryHeaders)

if(TARGET orrery)
  install(TARGETS orrery RUNTIME COMPONENT runtime)
  install(TARGETS orrery_program orrery_http_module orrery_image_module orrery_formats_module
          RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/orrery COMPONENT runtime
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/orrery COMPONENT runtime)
endif()
set(documents ${PROJECT_BINARY_DIR}/docs)
install(FILES ${documents}/orrery.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT runtime)
install(FILES ${documents}/orrery.bash RENAME orrery COMPONENT runtime
        DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${documents}/orrery.fish COMPONENT runtime DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
# Debian's zsh searches the first folder below /usr/local, and the second below /usr.
foreach(folder IN ITEMS site-functions vendor-completions)
  install(FILES ${documents}/_orrery COMPONENT runtime DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/${folder})
endforeach()
# scenes/ contains examples to copy. Debian requires the licence under the name `copyright`.
install(DIRECTORY scenes/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/scenes COMPONENT runtime FILES_MATCHING PATTERN "*.toml")
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime RENAME copyright)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR}-dev COMPONENT development RENAME copyright)

# Debian's Python searches /usr/local/lib/python3.11/dist-packages, where `cmake --install` puts the package, and
# /usr/lib/python3/dist-packages, where Debian packages put theirs. Both are as far from libexec.
if(ORRERY_PYTHON)
  set(ORRERY_PYTHON_INSTALL_DIR lib/python${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}/dist-packages
      CACHE STRING "Folder of the Python package, two levels below lib")
  get_target_property(python_package orrery_python LIBRARY_OUTPUT_DIRECTORY)
  foreach(place IN ITEMS ${ORRERY_PYTHON_INSTALL_DIR}:python lib/python3/dist-packages:python_debian)
    string(REGEX MATCH "^(.*):(.*)$" ignored ${place})
    set(component COMPONENT ${CMAKE_MATCH_2})
    if(CMAKE_MATCH_2 STREQUAL "python_debian")
      list(APPEND component EXCLUDE_FROM_ALL)
    endif()
    install(TARGETS orrery_python LIBRARY DESTINATION ${CMAKE_MATCH_1}/orrery ${component})
    install(DIRECTORY src/python/orrery DESTINATION ${CMAKE_MATCH_1} ${component}
            FILES_MATCHING PATTERN "*.py" PATTERN "py.typed")
  endforeach()
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/python3-orrery COMPONENT python_debian RENAME copyright
          EXCLUDE_FROM_ALL)
endif()

# The library: the public headers and what they include, and the rooms that they need.
get_property(public GLOBAL PROPERTY ORRERY_PUBLIC)
orrery_included_headers(headers ${PROJECT_SOURCE_DIR}/src ${public})
foreach(header IN LISTS headers)
  get_filename_component(room ${header} DIRECTORY)
  install(FILES src/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/orrery/${room} COMPONENT development)
endforeach()
list(TRANSFORM public REPLACE "/.*" "")
orrery_linked_rooms(rooms ${public})
list(TRANSFORM rooms PREPEND orrery_)
install(TARGETS ${rooms} EXPORT orrery ARCHIVE COMPONENT development)

set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/orrery)
install(EXPORT orrery NAMESPACE orrery:: FILE orreryTargets.cmake DESTINATION ${config_dir} COMPONENT development)
configure_package_config_file(cmake/orreryConfig.cmake.in ${PROJECT_BINARY_DIR}/orreryConfig.cmake
                              INSTALL_DESTINATION ${config_dir} NO_SET_AND_CHECK_MACRO)
# A minor version may change the interface of the library.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/orreryConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/orreryConfig.cmake ${PROJECT_BINARY_DIR}/orreryConfigVersion.cmake
              cmake/OrreryDependencies.cmake
        DESTINATION ${config_dir} COMPONENT development)

# Packages install to /usr, builds to /usr/local.
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_VENDOR "The orrery authors")
set(CPACK_PACKAGE_CONTACT "The orrery authors <noreply@example.org>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL runtime development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME orrery)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS fonts-dejavu-core)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS ffmpeg)
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION
    "Path tracing of up to millions of spheres with Embree: scene files in\n TOML, images as EXR, HDR, PNG, JPEG, TIFF and PPM.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME orrery-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
    "Static libraries and headers of orrery, and a CMake package config for\n find_package(orrery).")
# The static libraries require the -dev packages that they were built with.
file(STRINGS tools/packages-build.txt build_packages REGEX "-dev( |$)")
list(TRANSFORM build_packages REPLACE " .*" "")
list(JOIN build_packages ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS)
if(ORRERY_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python_debian)
  set(CPACK_DEBIAN_PYTHON_DEBIAN_PACKAGE_NAME python3-orrery)
  set(CPACK_DEBIAN_PYTHON_DEBIAN_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_DEBIAN_PACKAGE_SHLIBDEPS ON)
  set(CPACK_COMPONENT_PYTHON_DEBIAN_DESCRIPTION "Path tracing of spheres from NumPy arrays: import orrery.")
  # The extension module is for one version of Python, and uses the modules of the program's package.
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_DEBIAN_PACKAGE_DEPENDS
      "orrery (= ${PROJECT_VERSION}), python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${next_minor}), python3-numpy")
endif()
include(CPack)
