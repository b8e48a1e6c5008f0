# SPDX-License-Identifier: Apache-2.0
# Installs the build, moves the installed tree, and configures, builds and runs the consumer against it. The move shows
# that the tree is relocatable, as a package requires.
file(REMOVE_RECURSE ${WORK})
function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "${command}\n${status}\n${output}")
  endif()
endfunction()
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/born)
file(RENAME ${WORK}/born ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/build -G ${GENERATOR} -DCMAKE_PREFIX_PATH=${WORK}/prefix
    -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=Release -DEXAMPLE=${SOURCE}/../../examples/cpp)
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/consumer)
run(${WORK}/build/example/spiral ${WORK}/spiral.png)
run(${WORK}/prefix/bin/orrery compare ${WORK}/spiral.png ${SOURCE}/../../examples/cpp/spiral.jpg --fail-above rmse=0.05)
file(STRINGS ${WORK}/spiral.png written REGEX "^spiral$")
if(NOT written)
  message(FATAL_ERROR "spiral.png is the preview: it does not name the program that wrote it")
endif()
run(sh ${SOURCE}/stop.sh ${WORK}/build/example/spiral ${WORK}/endless.png)
run(${WORK}/prefix/bin/orrery --version)

# The Python package finds the modules of the program in the moved tree.
file(GLOB python ${WORK}/prefix/lib/python3*/dist-packages)
if(PYTHON)
  run(${CMAKE_COMMAND} -E env PYTHONPATH=${python} PYTHONDONTWRITEBYTECODE=1 ${PYTHON} ${SOURCE}/check_python.py ${WORK})
  run(${PYTHON} ${SOURCE}/check_sbom.py ${WORK}/prefix)
endif()

# Installed files do not name the build folder.
file(GLOB_RECURSE texts ${WORK}/prefix/*.cmake ${WORK}/prefix/*.h)
foreach(text IN LISTS texts)
  file(STRINGS ${text} lines)
  foreach(line IN LISTS lines)
    string(FIND "${line}" "${BUILD}" at)
    if(NOT at EQUAL -1)
      message(FATAL_ERROR "${text} names the build folder:\n${line}")
    endif()
  endforeach()
endforeach()
