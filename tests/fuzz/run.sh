#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Fuzzes the readers with libFuzzer under the address and undefined-behaviour sanitizers. Needs clang.
#
#   tests/fuzz/run.sh scene|ply|overrides [SECONDS=600] [libFuzzer options]
#
# Crashing inputs (crash-*) and the corpus are kept in the build folder (ORRERY_FUZZ_BUILD, default build-fuzz).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

target=${1:-}
case "$target" in
  scene) seeds=scene ;;
  ply) seeds=ply ;;
  overrides) seeds=override ;;
  *)
    sed -n '3,8s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2
    exit 2
    ;;
esac
seconds=${2:-600}
shift $(($# < 2 ? $# : 2))

build=${ORRERY_FUZZ_BUILD:-build-fuzz}
mkdir -p "$build/corpus-$target"
# toml++ 3.3 declares code for some characters unreachable. As Debian compiles it, without assertions, it still handles
# them correctly, which readers_test.cpp checks for each character. So exclude it from the sanitizers.
echo 'src:*/toml\+\+/*' >"$build/not-ours.txt"
"${CLANGXX:-clang++}" -std=c++20 -O1 -g -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=all \
  -fsanitize-ignorelist="$build/not-ours.txt" \
  -DNDEBUG -DFAULT="fault_with_$target" -DTOML_HEADER_ONLY=1 -Isrc -Itests \
  tests/fuzz/long_run.cpp tests/fuzz/readers.cpp src/base/*.cpp src/scene/*.cpp src/format/*.cpp \
  -o "$build/fuzz_$target"
exec "$build/fuzz_$target" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -artifact_prefix="$build/" "$@" \
  "$build/corpus-$target" "tests/fuzz/corpus/$seeds"
