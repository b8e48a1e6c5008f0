# SPDX-License-Identifier: Apache-2.0
# Finds Python and pybind11 for the option ORRERY_PYTHON. Unless Python_EXECUTABLE is set, the Python is Debian's: one in
# the user's PATH usually has neither Debian's NumPy nor Debian's packages.
if(NOT Python_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "Python that the package is built for")
endif()
find_package(Python 3.11 COMPONENTS Interpreter Development.Module)
if(NOT Python_FOUND)
  message(FATAL_ERROR "ORRERY_PYTHON needs Python 3.11 or later with headers: install python3-dev, or set "
                      "Python_EXECUTABLE, or set ORRERY_PYTHON=OFF")
endif()
if(NOT SKBUILD) # pip installs NumPy after the build
  execute_process(COMMAND ${Python_EXECUTABLE} -c "import numpy" RESULT_VARIABLE status OUTPUT_QUIET ERROR_QUIET)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "ORRERY_PYTHON needs NumPy for ${Python_EXECUTABLE}: install python3-numpy, or set "
                        "Python_EXECUTABLE to a Python that has it, or set ORRERY_PYTHON=OFF")
  endif()
endif()
# Only its headers are used; its CMake functions would look for Python again.
find_path(pybind11_INCLUDE_DIR pybind11/numpy.h)
if(NOT pybind11_INCLUDE_DIR)
  message(FATAL_ERROR "ORRERY_PYTHON needs pybind11: install pybind11-dev, or set ORRERY_PYTHON=OFF")
endif()
