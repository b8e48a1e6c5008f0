#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Fails if orrery's speed relative to the book's program, or to a scalar loop on Embree's sphere points, is below a
# limit. Only ratios within one run are tested, of processor time on one thread in interleaved repetitions, so the result
# depends on neither the machine's speed nor its load. A ratio fails only if its whole interval is below the limit in
# three runs.
#
# The limits are 0.6 of the figures for AVX2 in docs/benchmarks.md. They detect unused SIMD lanes, packet traversal
# replaced by single rays where packets pay, or a kernel that is no longer inlined. They do not detect a loss of a tenth;
# for that, bench/instructions.py counts the instructions of two builds.
#
#   bench/regression.sh BUILD       BUILD: a build folder configured with -DORRERY_BENCH=ON
#
# Exit status: 0 no ratio is below its limit, 1 one is, 77 the processor has no AVX2, for which there are no limits.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
programs=${1:?usage: bench/regression.sh BUILD}/bench
result=$(mktemp)
trap 'rm -f "$result"' EXIT

scene=render/final_scene
measure() {
  "$programs/bench_render" --benchmark_filter="^$scene/(embree/(exact|fast)|baseline|native_points)/one_thread" \
    --benchmark_repetitions=5 --benchmark_enable_random_interleaving=true --benchmark_min_time=0.05 \
    --benchmark_out_format=json --benchmark_out="$result" >/dev/null 2>&1
}

# hold CASE LIMIT REFERENCE: fails the attempt if CASE is less than LIMIT times as fast as REFERENCE.
hold() {
  printf '%s: must be at least %s times as fast as %s\n' "$1" "$2" "$3"
  "$root/bench/compare.py" "$result" --to "$scene/$3" --filter "^$scene/$1\$" --fail-below "$2" || failed=1
}

for attempt in 1 2 3; do
  measure
  if ! grep -q '"instruction_set": "avx' "$result"; then
    echo "skipped: the limits are for AVX2 or better"
    exit 77
  fi
  failed=0
  printf 'attempt %s\n' "$attempt"
  hold embree/exact/one_thread/small 13.5 baseline/one_thread/small
  hold embree/fast/one_thread/small 17 baseline/one_thread/small
  hold embree/exact/one_thread 0.95 native_points/one_thread
  hold embree/fast/one_thread 1.4 native_points/one_thread
  if [ "$failed" -eq 0 ]; then exit 0; fi
done
exit 1
