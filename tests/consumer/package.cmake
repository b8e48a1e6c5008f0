# SPDX-License-Identifier: Apache-2.0
# Builds the Debian packages and checks their contents: the program with its dependencies, and the development files.
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
function(run out)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${WORK} RESULT_VARIABLE status OUTPUT_VARIABLE output
                  ERROR_VARIABLE error)
  if(NOT status EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}\n${status}\n${output}${error}")
  endif()
  set(${out} "${output}" PARENT_SCOPE)
endfunction()
function(must_match what text)
  foreach(expression IN LISTS ARGN)
    if(NOT text MATCHES "${expression}")
      message(FATAL_ERROR "${what} does not contain ${expression}:\n${text}")
    endif()
  endforeach()
endfunction()

run(ignored ${CPACK} -G DEB --config ${BUILD}/CPackConfig.cmake -B ${WORK})
file(GLOB program ${WORK}/orrery_*.deb)
file(GLOB python ${WORK}/python3-orrery_*.deb)
file(GLOB rooms ${WORK}/orrery-dev_*.deb)
if(NOT program OR NOT rooms)
  message(FATAL_ERROR "cpack wrote no packages to ${WORK}")
endif()
run(fields dpkg-deb --field ${program})
must_match("the program's package" "${fields}" "Package: orrery\n" "Depends: [^\n]*libembree" "Depends: [^\n]*libopenimageio"
           "Depends: [^\n]*libopencolorio" "Depends: [^\n]*libarchive" "Depends: [^\n]*libhdf5")
run(files dpkg-deb --contents ${program})
must_match("the program's package" "${files}" "/usr/bin/orrery\n"
           "/usr/libexec/orrery/orrery-program\n" "/usr/libexec/orrery/orrery-image\\.so\n"
           "/usr/libexec/orrery/orrery-formats\\.so\n" "/usr/share/doc/orrery/copyright\n"
           "/usr/share/man/man1/orrery\\.1\n" "/bash-completion/completions/orrery\n"
           "/zsh/vendor-completions/_orrery\n" "/fish/vendor_completions\\.d/orrery\\.fish\n")
if(files MATCHES "\\.(a|h|cmake)\n")
  message(FATAL_ERROR "the program's package contains development files:\n${files}")
endif()
run(fields dpkg-deb --field ${rooms})
must_match("the rooms' package" "${fields}" "Package: orrery-dev\n" "Depends: [^\n]*libembree-dev")
run(files dpkg-deb --contents ${rooms})
must_match("the rooms' package" "${files}" "/liborrery_render\\.a\n" "/include/orrery/render/render\\.h\n"
           "/cmake/orrery/orreryConfig\\.cmake\n")
if(files MATCHES "toml_tree\\.h|-inl\\.h|liborrery_cli")
  message(FATAL_ERROR "the rooms' package contains internals:\n${files}")
endif()

# The Python package, if it is built: imported from the unpacked packages, it finds the modules of the program's package.
if(PYTHON)
  if(NOT python)
    message(FATAL_ERROR "cpack wrote no package python3-orrery to ${WORK}")
  endif()
  run(fields dpkg-deb --field ${python})
  must_match("the Python package" "${fields}" "Package: python3-orrery\n" "Depends: [^\n]*orrery \\(= [0-9.]+\\)"
             "Depends: [^\n]*python3-numpy" "Depends: [^\n]*libembree")
  run(files dpkg-deb --contents ${python})
  must_match("the Python package" "${files}" "/usr/lib/python3/dist-packages/orrery/__init__\\.py\n"
             "/orrery/py\\.typed\n" "/orrery/_orrery\\.[^/]*\\.so\n"
             "/usr/share/doc/python3-orrery/copyright\n")
  run(ignored dpkg-deb --extract ${program} ${WORK}/unpacked)
  run(ignored dpkg-deb --extract ${python} ${WORK}/unpacked)
  set(packages ${WORK}/unpacked/usr/lib/python3/dist-packages)
  run(printed ${CMAKE_COMMAND} -E env PYTHONPATH=${packages} PYTHONDONTWRITEBYTECODE=1 ${PYTHON}
      ${CMAKE_CURRENT_LIST_DIR}/check_python.py ${WORK})
  must_match("Python's output" "${printed}" "x y z ${packages}/orrery")
endif()
