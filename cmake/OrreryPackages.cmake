# SPDX-License-Identifier: Apache-2.0
# The Debian packages of `cpack -G DEB` (tools/packages.sh): orrery, liborrery-dev and, with ORRERY_PYTHON,
# python3-orrery, for builds with ORRERY_STUBS=OFF. cmake/debian/stage.cmake adds the files that Debian's policy requires.
set(CPACK_COMPONENTS_ALL runtime development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_CONTACT "orrery maintainers <maintainers@users.noreply.h-seed-8d01e421.example>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "") # each package has its own
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/debian/stage.cmake)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_SOURCE orrery)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON) # of the same version

set(about "orrery renders spheres by path tracing: particle data of simulations,
structure databases and laser scans, from a hundred to a hundred million, and
the scenes of Ray Tracing in One Weekend. Images have guaranteed error bounds
and the same bits on any number of threads.")

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME orrery)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS fonts-dejavu-core)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS ffmpeg)
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION "${PROJECT_DESCRIPTION}
${about}

The program reads LAMMPS, XYZ, PDB, mmCIF, PLY, CSV, NumPy, LAS, GSD, HDF5 and
VTK files, and scenes in TOML. It writes EXR with layers for compositing, and
HDR, PNG, JPEG, TIFF, PPM and films. A view in the browser needs no display.
The processor must have SSE4.2, AES and PCLMUL.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME liborrery-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "${PROJECT_DESCRIPTION} - C++ library
${about}

This package contains static libraries, their public headers, and a CMake
package for find_package(orrery).")
# A program that links the static libraries needs what they were built with, except the tools of the build.
file(STRINGS tools/packages-build.txt build_packages REGEX "-dev( |$)|^openimageio-tools")
list(TRANSFORM build_packages REPLACE " .*" "")
list(JOIN build_packages ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS)

if(ORRERY_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python_debian)
  set(CPACK_DEBIAN_PYTHON_DEBIAN_PACKAGE_NAME python3-orrery)
  set(CPACK_DEBIAN_PYTHON_DEBIAN_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_DEBIAN_PACKAGE_SHLIBDEPS ON)
  set(CPACK_COMPONENT_PYTHON_DEBIAN_DESCRIPTION "${PROJECT_DESCRIPTION} - Python package
${about}

This package renders NumPy arrays: positions in, images and layers out.")
  # The package uses the modules of the program. Its extension module is for one version of Python.
  set(CPACK_COMPONENT_PYTHON_DEBIAN_DEPENDS runtime)
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_DEBIAN_PACKAGE_DEPENDS
      "python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${next_minor}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_DEBIAN_PACKAGE_SUGGESTS "python3-ase, python3-mdanalysis")
  set(CPACK_DEBIAN_PYTHON_DEBIAN_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/cmake/debian/postinst
                                                       ${PROJECT_SOURCE_DIR}/cmake/debian/prerm)
  set(CPACK_DEBIAN_PYTHON_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
endif()
include(CPack)
