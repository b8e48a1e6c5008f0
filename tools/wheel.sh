#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds a wheel of the Python package that needs no packages of the system: the extension module for Debian's Python, and
# the program, with their libraries. Its tag names the oldest glibc with which it works.
#
#   tools/wheel.sh [FOLDER]    default: build/wheel
#
# The wheel of a commit is the same in every build on the same system (tools/reproducible.sh).
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$root/tools/setup.sh"
umask 022
folder=$(realpath -m -- "${1:-$root/build/wheel}")

use_commit_date
install_missing "$root/tools/packages-build.txt" "$root/tools/packages-debian.txt" "$root/tools/packages-portable.txt"
# The build of test.sh serves as well.
if [ ! -f "$root/build/.configured-with" ]; then configure -DBUILD_TESTING=OFF -DORRERY_PYTHON=ON; fi
reconfigure -DORRERY_STUBS=ON -DORRERY_ISAS=all -DORRERY_PYTHON=ON
build 10 orrery
build 1 orrery_python
rm -f "$folder"/orrery-*.whl
"$root/tools/bundle.py" wheel "$root/build" "$folder"
