#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Fails if orrery's speed relative to the book's program, or to a scalar loop on Embree's sphere points, is below a
# limit. Only ratios within one run are tested, and a ratio fails only if its whole interval is below the limit, so the
# result depends little on the machine. The limits are a quarter below the figures in docs/benchmarks.md. Takes half a
# minute.
#
#   bench/regression.sh BUILD       BUILD: a build folder configured with -DORRERY_BENCH=ON
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
programs=${1:?usage: bench/regression.sh BUILD}/bench
part=$(mktemp -d)
trap 'rm -rf "$part"' EXIT

# measure PROGRAM FILTER: runs the matching cases in interleaved repetitions and writes $part/PROGRAM.json.
measure() {
  "$programs/$1" --benchmark_filter="$2" --benchmark_repetitions=7 --benchmark_enable_random_interleaving=true \
    --benchmark_min_time=0.1 --benchmark_out_format=json --benchmark_out="$part/$1.json" >/dev/null 2>&1
}

# hold PROGRAM CASE LIMIT REFERENCE: fails if CASE is less than LIMIT times as fast as REFERENCE.
status=0
hold() {
  printf '%s: must be at least %s times as fast as %s\n' "$2" "$3" "$4"
  "$root/bench/compare.py" "$part/$1.json" --to "$4" --filter "^$2\$" --fail-below "$3" || status=1
}

measure bench_render '^render/final_scene/(embree/(exact|fast)|baseline|native_points)/one_thread'
scene=render/final_scene
hold bench_render $scene/embree/exact/one_thread/small 14 $scene/baseline/one_thread/small
hold bench_render $scene/embree/fast/one_thread/small 18 $scene/baseline/one_thread/small
hold bench_render $scene/embree/exact/one_thread 1.3 $scene/native_points/one_thread
hold bench_render $scene/embree/fast/one_thread 1.6 $scene/native_points/one_thread
exit "$status"
