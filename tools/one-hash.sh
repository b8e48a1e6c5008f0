#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks that a scene with every material renders to the same bytes with different compilers, optimisation levels,
# numbers of threads, instruction sets and accelerators. Builds the program several times, which takes a few minutes.
#
#   tools/one-hash.sh [WORKDIR]      keeping WORKDIR speeds up the next run
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
work=${1:-$(mktemp -d)}
mkdir -p "$work"
scene="$root/tests/determinism/everything.toml"
reference=""
status=0

# picture NAME PROGRAM ARGS...: renders, hashes, and compares with the first hash. Prints the instruction set that ran, from
# --stats, which may not be the requested one.
picture() {
  local name=$1 program=$2 hash isa
  shift 2
  if ! "$program" render "$scene" -o "$work/picture.exr" --type float --reproducible -q --stats "$work/stats.json" "$@" \
    2>"$work/error"; then
    printf '%-44s skipped: %s\n' "$name" "$(head -n 1 "$work/error")"
    return
  fi
  isa=$(sed -n 's/.*"isa": "\(.*\)".*/\1/p' "$work/stats.json")
  hash=$(sha256sum <"$work/picture.exr" | cut -c1-16)
  reference=${reference:-$hash}
  printf '%-44s %s  %s\n' "$name" "$hash" "$isa"
  [ "$hash" = "$reference" ] || status=1
  case "${ORRERY_ISA:-$isa}" in "$isa") ;; *) echo "$name: ran with $isa, not with the requested instruction set"; status=1 ;; esac
}

# program NAME COMPILER FLAGS: builds the program, prints its path.
program() {
  local build="$work/$1"
  if ! command -v "$2" >/dev/null; then return 1; fi
  cmake -S "$root" -B "$build" -G Ninja -DBUILD_TESTING=OFF -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_COMPILER="$2" -DCMAKE_CXX_FLAGS="$3" >"$work/$1.log" 2>&1 &&
    cmake --build "$build" --target orrery >>"$work/$1.log" 2>&1 || { tail -n 20 "$work/$1.log" >&2; return 1; }
  printf '%s\n' "$build/src/orrery"
}

first=$(program gcc-O3 g++ "-O3 -DNDEBUG")
for threads in 1 2 7; do picture "GCC -O3, $threads threads" "$first" -t "$threads"; done
picture "GCC -O3, list" "$first" --set render.accelerator=list
for isa in avx2 avx512; do ORRERY_ISA=$isa picture "GCC -O3, $isa" "$first"; done
if p=$(program gcc-O0 g++ "-O0"); then picture "GCC -O0" "$p"; fi
if p=$(program gcc-native g++ "-O3 -march=native -DNDEBUG"); then picture "GCC -O3 -march=native" "$p"; fi
if p=$(program clang-O2 clang++ "-O2 -DNDEBUG"); then picture "Clang -O2" "$p"; fi
if p=$(program clang-native clang++ "-O3 -march=native -DNDEBUG"); then picture "Clang -O3 -march=native" "$p"; fi
"$first" --version | grep -E 'Embree'
if [ "$status" -eq 0 ]; then echo "all hashes are equal"; else echo "HASHES DIFFER"; fi
exit "$status"
