# SPDX-License-Identifier: Apache-2.0
# Run by cpack before it writes the packages: adds Debian's changelog and copyright, and compresses what Debian's policy
# wants compressed. Dates come from SOURCE_DATE_EPOCH, if it is set.
function(compress file)
  execute_process(COMMAND gzip -9nf ${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
set(source ${CMAKE_CURRENT_LIST_DIR}/../..)
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} name)
  set(root ${CPACK_TEMPORARY_DIRECTORY}/${component}/usr)
  set(documents ${root}/share/doc/${CPACK_DEBIAN_${name}_PACKAGE_NAME})
  configure_file(${CMAKE_CURRENT_LIST_DIR}/copyright ${documents}/copyright @ONLY)
  file(REMOVE ${documents}/LICENSE)
  file(WRITE ${documents}/changelog.Debian
       "orrery (${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}) unstable; urgency=medium\n\n"
       "  * Built from the sources; changes are listed in changelog.gz.\n\n -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")
  compress(${documents}/changelog.Debian)
  configure_file(${source}/CHANGELOG.md ${documents}/changelog COPYONLY)
  compress(${documents}/changelog)
  file(GLOB manuals ${root}/share/man/man*/*[0-9])
  foreach(manual IN LISTS manuals)
    compress(${manual})
  endforeach()
  file(REMOVE_RECURSE ${root}/share/zsh/site-functions) # the folder for /usr/local
endforeach()
