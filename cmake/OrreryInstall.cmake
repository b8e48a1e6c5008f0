# SPDX-License-Identifier: Apache-2.0
# Installation, and the package config for find_package(orrery).
include(CMakePackageConfigHelpers)
include(OrreryHeaders)

# In a wheel (pyproject.toml) the Python package is at the root, and all else is data, which pip installs to the prefix.
if(SKBUILD)
  foreach(folder IN ITEMS BINDIR LIBEXECDIR MANDIR DATADIR DOCDIR)
    set(CMAKE_INSTALL_${folder} ${SKBUILD_DATA_DIR}/${CMAKE_INSTALL_${folder}})
  endforeach()
  set(ORRERY_PYTHON_INSTALL_DIR .)
endif()

if(TARGET orrery)
  install(TARGETS orrery RUNTIME COMPONENT runtime)
  install(TARGETS orrery_program orrery_http_module orrery_image_module orrery_data_module
          RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/orrery COMPONENT runtime
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/orrery COMPONENT runtime)
  if(ORRERY_STUBS)
    foreach(room IN ITEMS image data http)
      install(DIRECTORY $<TARGET_FILE_DIR:orrery_program>/orrery-${room}-stubs
              DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/orrery COMPONENT runtime)
    endforeach()
  endif()
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
# scenes/ contains examples to copy.
install(DIRECTORY scenes/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/scenes COMPONENT runtime FILES_MATCHING PATTERN "*.toml" PATTERN "*.jpg" PATTERN "studio.exr")
install(DIRECTORY src/display/config/ DESTINATION ${CMAKE_INSTALL_DATADIR}/orrery COMPONENT runtime FILES_MATCHING PATTERN "*.ocio")
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime)

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
