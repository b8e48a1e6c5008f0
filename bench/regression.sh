#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Fails where orrery has become slower than it may be, beside the program of the book and beside a scalar loop on Embree's
# own sphere points. Only ratios within one run are judged, and only where a whole interval lies below the limit, so the
# machine does not matter much; the limits lie a quarter below what docs/benchmarks.md shows. Half a minute.
#
#   bench/regression.sh BUILD       a build folder that was configured with -DORRERY_BENCH=ON
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
programs=${1:?name the build folder}/bench
part=$(mktemp -d)
trap 'rm -rf "$part"' EXIT

# measure PROGRAM FILTER: alternating repetitions of these cases, as $part/PROGRAM.json.
measure() {
  "$programs/$1" --benchmark_filter="$2" --benchmark_repetitions=7 --benchmark_enable_random_interleaving=true \
    --benchmark_min_time=0.1 --benchmark_out_format=json --benchmark_out="$part/$1.json" >/dev/null 2>&1
}

# hold PROGRAM CASE LIMIT REFERENCE: the case is LIMIT times as fast as the reference, or the run fails.
status=0
hold() {
  printf '%s: at least %s times %s\n' "$2" "$3" "$4"
  "$root/bench/compare.py" "$part/$1.json" --to "$4" --filter "^$2\$" --fail-below "$3" || status=1
}

measure bench_render '^render/final_scene/(embree/(exact|fast)|baseline|native_points)/one_thread'
scene=render/final_scene
hold bench_render $scene/embree/exact/one_thread/small 14 $scene/baseline/one_thread/small
hold bench_render $scene/embree/fast/one_thread/small 18 $scene/baseline/one_thread/small
hold bench_render $scene/embree/exact/one_thread 1.3 $scene/native_points/one_thread
hold bench_render $scene/embree/fast/one_thread 1.6 $scene/native_points/one_thread
exit "$status"
