#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Fails if orrery's speed relative to the book's program, or to a scalar loop on Embree's sphere points, is below a
# limit. Only ratios within one run are tested, of processor time on one thread in interleaved repetitions, so the result
# depends on neither the machine's speed nor its load. A ratio fails only if its whole interval is below the limit in
# three runs.
#
# The first limits are 0.6 of the figures of a Zen 3 with AVX2, and 0.4 of those of docs/benchmarks.md. They detect unused SIMD lanes, packet traversal
# replaced by single rays where packets pay, or a kernel that is no longer inlined. They do not detect a loss of a tenth;
# for that, bench/instructions.py counts the instructions of two builds.
#
# On scenes of bench/render/traversal.cpp, with AVX-512 and AVX2, the traversals of the rule must reach 0.9 of the better one
# of packets and single rays: one scene for each case of the rule, or with `all` every scene.
#
#   bench/regression.sh BUILD [all]       BUILD: a build folder configured with -DORRERY_BENCH=ON
#
# Exit status: 0 no ratio is below its limit, 1 one is, 77 the processor has no AVX2, for which there are no limits.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
programs=${1:?usage: bench/regression.sh BUILD [all]}/bench
scenes='final|layer/6400|cloud/10000'
if [ "${2:-}" = all ]; then scenes='.*'; fi
result=$(mktemp)
trap 'rm -f "$result"' EXIT

# measure FILTER: measures these cases.
measure() {
  "$programs/bench_render" --benchmark_filter="$1" --benchmark_repetitions=5 \
    --benchmark_enable_random_interleaving=true --benchmark_min_time=0.05 \
    --benchmark_out_format=json --benchmark_out="$result" >/dev/null 2>&1
}

# hold CASE LIMIT REFERENCE: fails the attempt if CASE is less than LIMIT times as fast as REFERENCE.
hold() {
  printf '%s: must be at least %s times as fast as %s\n' "$1" "$2" "$3"
  "$root/bench/compare.py" "$result" --to "$3" --filter "^$1\$" --fail-below "$2" || failed=1
}

final_scene() {
  local scene=render/final_scene
  measure "^$scene/(embree/(exact|fast)|baseline|native_points)/one_thread"
  hold $scene/embree/exact/one_thread/small 13.5 $scene/baseline/one_thread/small
  hold $scene/embree/fast/one_thread/small 17 $scene/baseline/one_thread/small
  hold $scene/embree/exact/one_thread 0.95 $scene/native_points/one_thread
  hold $scene/embree/fast/one_thread 1.4 $scene/native_points/one_thread
}

# traversals SCENE
traversals() {
  measure "^render/traversal/$1/"
  for case in $(grep -o 'render/traversal/[^"]*/rule' "$result" | sort -u); do
    hold "$case" 0.9 "${case%/rule}/packets"
    hold "$case" 0.9 "${case%/rule}/single"
  done
}

# The cases of traversals.
names() {
  "$programs/bench_render" --benchmark_list_tests --benchmark_filter=render/traversal
}

# attempt TEST...: ends the script if the test fails three times.
attempt() {
  for number in 1 2 3; do
    printf '%s, attempt %s\n' "$*" "$number"
    failed=0
    "$@"
    if [ "$failed" -eq 0 ]; then return; fi
  done
  exit 1
}

if [ -z "$(names | awk '/avx/')" ]; then
  echo "skipped: the limits are for AVX2 or better"
  exit 77
fi
attempt final_scene
for scene in $(names | sed -n -E "s#^render/traversal/($scenes)/avx[0-9]*/fast/rule\$#\1#p" | sort -u); do
  attempt traversals "$scene"
done
