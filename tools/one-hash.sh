#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Renders one scene with every material in many ways and compares the pictures' bytes: compilers, optimisation levels,
# threads, instruction sets, accelerators. Takes some minutes, since it builds the program several times.
#
#   tools/one-hash.sh [WORKDIR]      a kept WORKDIR makes the second run quick
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
work=${1:-$(mktemp -d)}
mkdir -p "$work"
scene="$root/tests/determinism/everything.toml"
reference=""
status=0

# picture NAME PROGRAM ARGS...: renders, hashes, compares with the first. The instruction set is the one that ran, as
# --stats reports it, not the one that was requested.
picture() {
  local name=$1 program=$2 hash isa
  shift 2
  if ! "$program" render "$scene" -o "$work/picture.exr" --type float --reproducible -q --stats "$work/stats.json" "$@" \
    2>"$work/error"; then
    printf '%-44s left out: %s\n' "$name" "$(head -n 1 "$work/error")"
    return
  fi
  isa=$(sed -n 's/.*"isa": "\(.*\)".*/\1/p' "$work/stats.json")
  hash=$(sha256sum <"$work/picture.exr" | cut -c1-16)
  reference=${reference:-$hash}
  printf '%-44s %s  %s\n' "$name" "$hash" "$isa"
  [ "$hash" = "$reference" ] || status=1
  case " $* " in *" --isa $isa "*) ;; *" --isa "*) echo "another instruction set than requested ran"; status=1 ;; esac
}

# program NAME COMPILER FLAGS: builds once, prints the path.
program() {
  local build="$work/$1"
  if ! command -v "$2" >/dev/null; then return 1; fi
  cmake -S "$root" -B "$build" -G Ninja -DBUILD_TESTING=OFF -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_COMPILER="$2" -DCMAKE_CXX_FLAGS="$3" >"$work/$1.log" 2>&1 &&
    cmake --build "$build" --target orrery >>"$work/$1.log" 2>&1 || { tail -n 20 "$work/$1.log" >&2; return 1; }
  printf '%s\n' "$build/src/orrery"
}

first=$(program gcc-O3 g++ "-O3 -DNDEBUG")
for threads in 1 2 7; do picture "GCC -O3, $threads threads" "$first" -t "$threads"; done
picture "GCC -O3, list" "$first" --accelerator list
for isa in avx2 avx512; do picture "GCC -O3, --isa $isa" "$first" --isa "$isa"; done
if p=$(program gcc-O0 g++ "-O0"); then picture "GCC -O0" "$p"; fi
if p=$(program gcc-native g++ "-O3 -march=native -DNDEBUG"); then picture "GCC -O3 -march=native" "$p"; fi
if p=$(program clang-O2 clang++ "-O2 -DNDEBUG"); then picture "Clang -O2" "$p"; fi
if p=$(program clang-native clang++ "-O3 -march=native -DNDEBUG"); then picture "Clang -O3 -march=native" "$p"; fi
"$first" --version | grep -E 'Embree'
if [ "$status" -eq 0 ]; then echo "one hash"; else echo "NOT one hash"; fi
exit "$status"
