#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what is missing, builds, and runs every test but the slow ones. Arguments go to ctest instead of `-LE slow`.
#
#   ./test.sh
#   ./test.sh -L unit
#   ./test.sh -R Camera
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$root/tools/setup.sh"

install_missing "$root/tools/packages-build.txt" "$root/tools/packages-test.txt"
configure -DBUILD_TESTING=ON -DORRERY_BENCH=ON
build 10 all

if [ $# -eq 0 ]; then set -- -LE slow; fi
# The summary of labels would stand behind the line that counts.
set -- --test-dir "$root/build" --no-tests=error --output-on-failure --no-label-summary --parallel "$(nproc)" "$@"
say "Testing ..."
if [ -t 1 ]; then
  ctest --progress "$@"
else
  # In a log what passed needs no line; ctest's exit status counts, not the filter's.
  ctest "$@" | { grep --line-buffered -vE '^ *[0-9]+/[0-9]+ Test +#.* Passed |^ +Start +[0-9]+: ' || true; }
fi
