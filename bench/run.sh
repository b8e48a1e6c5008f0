#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the results that are checked in: all repetitions of all cases, in random order, as
# bench/results/<machine>/<room>.json.
#
#   bench/run.sh MACHINE [GOOGLE BENCHMARK OPTION...]
#   bench/run.sh amd-zen3-2cores
#   bench/run.sh mine --benchmark_filter=final
#
# MACHINE names a folder: processor and cores, not a host. Takes a quarter of an hour; a busy machine is told, and
# refused unless ORRERY_BENCH_BUSY=1 says that it is meant. ORRERY_BENCH_REPETITIONS (7) and ORRERY_BENCH_BUILD, a build
# folder that is already configured with -DORRERY_BENCH=ON, change what their names say.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

fail() { printf 'bench/run.sh: error: %s\n' "$1" >&2; exit "${2:-1}"; }

machine=${1:-}
case $machine in
  "" | -* | *[!a-z0-9-]*)
    fail "name the machine first, in small letters, digits and dashes: bench/run.sh amd-zen3-2cores" 2
    ;;
esac
shift

load=$(cut -d ' ' -f 1 /proc/loadavg)
if awk -v load="$load" 'BEGIN { exit !(load >= 1) }'; then
  printf 'bench/run.sh: warning: the load is %s; other work makes these figures worse than they are\n' "$load" >&2
  [ "${ORRERY_BENCH_BUSY:-}" = 1 ] || fail "wait until it is below 1, or set ORRERY_BENCH_BUSY=1"
fi

build=${ORRERY_BENCH_BUILD:-$root/build-bench}
if [ ! -f "$build/CMakeCache.txt" ]; then
  cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DORRERY_BENCH=ON -DBUILD_TESTING=OFF >/dev/null
fi
cmake --build "$build" --target bench_kernel bench_accel bench_render bench_same_picture >/dev/null ||
  fail "the build failed; 'cmake --build $build' shows why"
cd "$build/bench"
./bench_same_picture >/dev/null ||
  fail "the baseline computes another picture than orrery: run $build/bench/bench_same_picture"

# What the figures belong to.
revision=$(git -C "$root" describe --always --dirty 2>/dev/null || echo unknown)
processor=$(sed -n 's/^model name[[:space:]]*: //p' /proc/cpuinfo | head -n 1)
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
  # A filter may leave nothing of a room.
  if ! grep -q '"run_type"' "$part/$room.json"; then continue; fi
  "$root/bench/tidy.py" "$part/$room.json" >"$part/tidy.json" || fail "bench_$room wrote what bench/tidy.py can't read"
  mv "$part/tidy.json" "$results/$room.json"
done
printf 'Results are in bench/results/%s; bench/compare.py makes tables of them.\n' "$machine"
