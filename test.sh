#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs missing packages, builds, and runs all tests except the slow ones. Arguments are passed to ctest instead of
# `-LE slow`.
#
#   ./test.sh
#   ./test.sh -L unit
#   ./test.sh -R Camera
#
# ORRERY_BENCH=OFF   without the benchmarks
#
# Tests write their files to $TMPDIR if set, otherwise to /dev/shm if it has 2 GB of free space, otherwise to /tmp. On a disk
# that syncs every write some tests take twenty times as long.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$root/tools/setup.sh"

install_missing "$root/tools/packages-build.txt" "$root/tools/packages-debian.txt" "$root/tools/packages-portable.txt" \
  "$root/tools/packages-test.txt"
# Other systems may lack what the Python package needs.
python=ON
command -v dpkg-query >/dev/null || python=OFF
configure -DBUILD_TESTING=ON -DORRERY_ISAS=all "-DORRERY_BENCH=${ORRERY_BENCH:-ON}" "-DORRERY_PYTHON=$python"
build 20 all

if [ $# -eq 0 ]; then set -- -LE slow; fi
if [ -z "${TMPDIR:-}" ] && [ "$(stat -f -c %T /dev/shm 2>/dev/null)" = tmpfs ] && [ -w /dev/shm ] &&
  [ "$(df --output=avail -B 1M /dev/shm | tail -n 1)" -ge 2048 ]; then
  TMPDIR=$(mktemp -d /dev/shm/orrery-tests.XXXXXX)
  chmod 711 "$TMPDIR"  # some tests become another user
  export TMPDIR
  trap 'rm -rf "$TMPDIR"' EXIT
fi
log=$root/build/test.log
# A test that hangs is a failed test with a name. Without ctest's label summary the result is the last line. One test more
# than there are CPUs, because some wait: for a job scheduler, a browser, or another process.
set -- --test-dir "$root/build" --no-tests=error --output-on-failure --no-label-summary --parallel $(($(nproc) + 1)) \
  --timeout 900 --output-log "$log" "$@"
say "Testing ..."
begin=$SECONDS status=0
if [ -t 1 ]; then
  ctest --progress "$@" || status=$?
else
  # Passed tests are not logged. The closing lines follow the times below.
  ctest "$@" | sed -u -E '/^ *[0-9]+\/[0-9]+ Test +#.* Passed |^ +Start +[0-9]+: /d; /^[0-9]+% tests passed/,$d' || status=$?
  printf 'Built in %s s, tested in %s s. The slowest tests:\n' "$build_seconds" $((SECONDS - begin))
  # Columns: name, number of runs, mean seconds. There is none if no test ran, as with -N.
  costs="$root/build/Testing/Temporary/CTestCostData.txt"
  if [ -f "$costs" ]; then
    sed '/^---/,$d' "$costs" | sort -k3,3nr | awk '$2 > 0 && ++n <= 10 { printf "%8.1f s  %s\n", $3, $1 }'
  fi
  sed -n '/^[0-9]*% tests passed/,$p' "$log"
fi
exit "$status"
