#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Produces the checked-in results: all repetitions of all cases in random order, written to
# bench/results/<machine>/<room>.json.
#
#   bench/run.sh MACHINE [GOOGLE BENCHMARK OPTION...]
#   bench/run.sh amd-zen5-2cores
#   bench/run.sh mine --benchmark_filter=final
#
# MACHINE names the folder by processor and core count, not by host. Takes a quarter of an hour. Refuses to run on a
# busy machine unless ORRERY_BENCH_BUSY=1 is set. Other variables:
#   ORRERY_BENCH_REPETITIONS   number of repetitions, default 7
#   ORRERY_BENCH_BUILD         build folder already configured with -DORRERY_BENCH=ON; default build-bench
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

fail() { printf 'bench/run.sh: error: %s\n' "$1" >&2; exit "${2:-1}"; }

machine=${1:-}
case $machine in
  "" | -* | *[!a-z0-9-]*)
    fail "name the machine first, in lower-case letters, digits and dashes: bench/run.sh amd-zen5-2cores" 2
    ;;
esac
shift

load=$(cut -d ' ' -f 1 /proc/loadavg)
if awk -v load="$load" 'BEGIN { exit !(load >= 1) }'; then
  printf 'bench/run.sh: warning: the load average is %s; other processes make these figures unreliable\n' "$load" >&2
  [ "${ORRERY_BENCH_BUSY:-}" = 1 ] || fail "wait until the load is below 1, or set ORRERY_BENCH_BUSY=1"
fi

build=${ORRERY_BENCH_BUILD:-$root/build-bench}
if [ ! -f "$build/CMakeCache.txt" ]; then
  cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DORRERY_BENCH=ON -DBUILD_TESTING=OFF >/dev/null
fi
cmake --build "$build" --target bench_kernel bench_accel bench_render bench_same_picture >/dev/null ||
  fail "the build failed; run 'cmake --build $build' to see why"
cd "$build/bench"
./bench_same_picture >/dev/null ||
  fail "the baseline and orrery compute different images; run $build/bench/bench_same_picture for details"

# Recorded with the results.
revision=$(git -C "$root" describe --always --dirty 2>/dev/null || echo unknown)
processor=$(awk -F': ' '/^model name/ { print $2; exit }' /proc/cpuinfo)
results="$root/bench/results/$machine"
mkdir -p "$results"
part=$(mktemp -d)
trap 'rm -rf "$part"' EXIT
for room in kernel accel render; do
  printf 'Measuring %s ...\n' "$room"
  "./bench_$room" --benchmark_repetitions="${ORRERY_BENCH_REPETITIONS:-7}" \
    --benchmark_enable_random_interleaving=true --benchmark_min_time=0.2 \
    --benchmark_context="revision=$revision,processor=${processor//[,=]/ }" \
    --benchmark_out_format=json --benchmark_out="$part/$room.json" "$@" >/dev/null 2>"$part/messages" ||
    { cat "$part/messages" >&2; fail "bench_$room failed"; }
  # A filter may exclude every case of a room.
  if ! grep -q '"run_type"' "$part/$room.json"; then continue; fi
  "$root/bench/tidy.py" "$part/$room.json" >"$part/tidy.json" || fail "bench/tidy.py cannot read the output of bench_$room"
  mv "$part/tidy.json" "$results/$room.json"
done
printf 'Results are in bench/results/%s; use bench/compare.py to tabulate them.\n' "$machine"
