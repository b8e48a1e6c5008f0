# SPDX-License-Identifier: Apache-2.0
# Writes and installs orrery.spdx.json, the software bill of materials (SPDX 2.3): orrery, and the libraries that it loads
# or contains, with the versions of the Debian packages that it is built with. tests/consumer/check_sbom.py compares it
# with the installed binaries.

# Name | licence | Debian package | version where there is no dpkg | relationship
set(gemmi_is STATIC_LINK) # Debian 12 has headers only, Debian 13 a static library
if(ORRERY_GEMMI_LIBRARY MATCHES "\\.so$")
  set(gemmi_is DYNAMIC_LINK)
endif()
set(libraries
    "embree|Apache-2.0|libembree-dev|${embree_VERSION}|DYNAMIC_LINK"
    "onetbb|Apache-2.0|libtbb-dev|${TBB_VERSION}|DYNAMIC_LINK"
    "highway|Apache-2.0|libhwy-dev|${HWY_VERSION}|DYNAMIC_LINK"
    "fmt|MIT|libfmt-dev|${fmt_VERSION}|DYNAMIC_LINK"
    "openimageio|Apache-2.0|libopenimageio-dev|${OpenImageIO_VERSION}|DYNAMIC_LINK"
    "opencolorio|BSD-3-Clause|libopencolorio-dev|${OpenColorIO_VERSION}|DYNAMIC_LINK"
    "libjpeg-turbo|IJG AND BSD-3-Clause AND Zlib|libjpeg-dev|${JPEG_VERSION}|DYNAMIC_LINK"
    "freetype|FTL OR GPL-2.0-or-later|libfreetype-dev|${FREETYPE_VERSION_STRING}|DYNAMIC_LINK"
    "libarchive|BSD-2-Clause|libarchive-dev|${LibArchive_VERSION}|DYNAMIC_LINK"
    "hdf5|BSD-3-Clause|libhdf5-dev||DYNAMIC_LINK"
    "pugixml|MIT|libpugixml-dev|${pugixml_VERSION}|DYNAMIC_LINK"
    "libmicrohttpd|LGPL-2.1-or-later|libmicrohttpd-dev||DYNAMIC_LINK"
    "zlib|Zlib|zlib1g-dev|${ZLIB_VERSION}|DYNAMIC_LINK"
    "glibc|LGPL-2.1-or-later|libc6||DYNAMIC_LINK"
    "libstdc++|GPL-3.0-or-later WITH GCC-exception-3.1|libstdc++6||DYNAMIC_LINK"
    "gemmi|MPL-2.0|gemmi-dev||${gemmi_is}"
    "tomlplusplus|MIT|libtomlplusplus-dev|${tomlplusplus_VERSION}|DYNAMIC_LINK"
    "cli11|BSD-3-Clause|libcli11-dev|${CLI11_VERSION}|STATIC_LINK"
    "nlohmann-json|MIT|nlohmann-json3-dev|${nlohmann_json_VERSION}|STATIC_LINK")
if(ORRERY_PYTHON)
  list(APPEND libraries "pybind11|BSD-3-Clause|pybind11-dev||STATIC_LINK")
endif()
file(GLOB third_party LIST_DIRECTORIES ON ${PROJECT_SOURCE_DIR}/third_party/*)
list(REMOVE_ITEM third_party ${PROJECT_SOURCE_DIR}/third_party/README.md)
if(third_party)
  message(FATAL_ERROR "${third_party}: add a row to cmake/OrrerySbom.cmake")
endif()

find_program(DPKG_QUERY dpkg-query)
mark_as_advanced(DPKG_QUERY)
if(DPKG_QUERY)
  file(STRINGS /etc/os-release distribution REGEX "^ID=")
  string(REGEX REPLACE "^ID=" "" distribution "${distribution}")
endif()

# orrery_sbom_package(<row of libraries>): appends the library to `packages` and `relationships`.
function(orrery_sbom_package row)
  string(REPLACE "|" ";" row "${row}")
  list(POP_FRONT row name license debian_package version relationship)
  set(details "")
  set(debian_version "")
  if(DPKG_QUERY)
    execute_process(COMMAND ${DPKG_QUERY} -W -f "\${Version}" ${debian_package} OUTPUT_VARIABLE debian_version ERROR_QUIET)
  endif()
  if(debian_version)
    set(version ${debian_version})
    string(REPLACE "+" "%2B" locator "pkg:deb/${distribution}/${debian_package}@${version}")
    string(APPEND details "\"externalRefs\": [{\"referenceCategory\": \"PACKAGE-MANAGER\", \"referenceType\": \"purl\", "
           "\"referenceLocator\": \"${locator}\"}], ")
  endif()
  if(version)
    string(APPEND details "\"versionInfo\": \"${version}\", ")
  endif()
  string(REPLACE "+" "x" id "SPDXRef-${name}") # identifiers are letters, digits, dots and hyphens
  string(APPEND packages ",\n    {\"SPDXID\": \"${id}\", \"name\": \"${name}\", ${details}"
         "\"licenseDeclared\": \"${license}\", \"licenseConcluded\": \"NOASSERTION\", \"copyrightText\": \"NOASSERTION\", "
         "\"downloadLocation\": \"NOASSERTION\", \"filesAnalyzed\": false, \"primaryPackagePurpose\": \"LIBRARY\"}")
  string(APPEND relationships ",\n    {\"spdxElementId\": \"SPDXRef-orrery\", "
         "\"relationshipType\": \"${relationship}\", \"relatedSpdxElement\": \"${id}\"}")
  set(packages "${packages}" PARENT_SCOPE)
  set(relationships "${relationships}" PARENT_SCOPE)
endfunction()

set(packages "")
set(relationships "")
foreach(row IN LISTS libraries)
  orrery_sbom_package("${row}")
endforeach()
string(TIMESTAMP created "%Y-%m-%dT%H:%M:%SZ" UTC) # SOURCE_DATE_EPOCH, if that is set
# The namespace must be unique to the contents.
string(UUID uuid NAMESPACE 6ba7b811-9dad-11d1-80b4-00c04fd430c8 NAME "${PROJECT_VERSION} ${created} ${packages}" TYPE SHA1)
configure_file(cmake/orrery.spdx.json.in ${PROJECT_BINARY_DIR}/docs/orrery.spdx.json @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/docs/orrery.spdx.json DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT runtime)
