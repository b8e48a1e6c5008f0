#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Fuzzes the readers with libFuzzer under the address and undefined-behaviour sanitizers. Needs clang.
#
#   tests/fuzz/run.sh scene|ply|overrides|data|hdf5|selection|color_map|wish [SECONDS=600] [FOLDER...] [libFuzzer options]
#
# FOLDER: additional seed files, for example damaged ones from the tests of other programs. They are not changed.
#
# `data` covers all formats except HDF5, which `hdf5` covers: libhdf5 1.10 itself crashes on some damaged files.
# Crashing inputs (crash-*) and the corpus are kept in the build folder (ORRERY_FUZZ_BUILD, default build-fuzz).
set -euo pipefail
from=$PWD
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

target=${1:-}
case "$target" in
  scene | ply | selection | color_map | wish) seeds=(tests/fuzz/corpus/"$target") ;;
  overrides) seeds=(tests/fuzz/corpus/override) ;;
  hdf5) seeds=(tests/fuzz/corpus/data/hdf5) ;;
  data)
    seeds=(tests/fuzz/corpus/ply)
    for folder in tests/fuzz/corpus/data/*; do
      [[ $folder == */hdf5 ]] || seeds+=("$folder")
    done
    ;;
  *)
    sed -n '3,10s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2
    exit 2
    ;;
esac
seconds=${2:-600}
shift $(($# < 2 ? $# : 2))
options=()
for argument in "$@"; do
  if [[ $argument == -* ]]; then
    options+=("$argument")
  else
    seeds+=("$(cd "$from" && cd "$argument" && pwd)")
  fi
done

build=${ORRERY_FUZZ_BUILD:-build-fuzz}
objects=$build/objects
mkdir -p "$build/corpus-$target" "$objects"
# toml++ 3.3 declares code for some characters unreachable. As Debian compiles it, without assertions, it still handles
# them correctly, which readers_test.cpp checks for each character. So exclude it from the sanitizers.
echo 'src:*/toml\+\+/*' >"$build/not-ours.txt"
flags=(-O1 -g "-fsanitize=address,undefined" -fno-sanitize-recover=all "-fsanitize-ignorelist=$build/not-ours.txt"
  -DNDEBUG -DTOML_HEADER_ONLY=1 -Isrc -Itests)
[[ ! -d /usr/include/hdf5/serial ]] || flags+=(-isystem /usr/include/hdf5/serial)
libraries=(-ltbb -larchive -lfmt -lpugixml -lz)
for library in hdf5_serial hdf5 gemmi_cpp; do # as cmake/OrreryDependencies.cmake finds them
  ! compgen -G "/usr/lib/*/lib$library.so" >/dev/null || libraries+=("-l$library")
done
clang=${CLANGXX:-clang++}
compiler=("$clang")
! command -v ccache >/dev/null || compiler=(ccache "$clang")

# Compiles a file. gemmi's CIF has vectors of an incomplete type, which clang rejects in C++20 with libstdc++ 12.
compile() {
  local file=$1 standard=c++20
  shift
  [[ $file != */cif_rows.cpp ]] || standard=c++17
  "$@" -std=$standard -fsanitize=fuzzer-no-link -c "$file" -o "$objects/${file//\//_}.o"
}
export -f compile
export objects
# The rooms that read files, and of `load` what reads a scene with its data. Images and displays, which it could load as
# well, are not linked: no target gets there.
printf '%s\0' tests/fuzz/readers.cpp src/{base,scene,data,points}/*.cpp src/load/{diagnostics,load_scene,overrides,read_*,toml_tree,write_scene}.cpp src/view/wish.cpp |
  xargs -0 -P "$(nproc)" -I{} bash -c 'compile "$@"' - {} "${compiler[@]}" "${flags[@]}"
"$clang" -std=c++20 "${flags[@]}" -fsanitize=fuzzer -no-pie -Wl,--unresolved-symbols=ignore-in-object-files \
  -DFAULT="fault_with_${target/hdf5/data}" tests/fuzz/long_run.cpp "$objects"/*.o "${libraries[@]}" -o "$build/fuzz_$target"
exec "$build/fuzz_$target" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -artifact_prefix="$build/" "${options[@]}" \
  "$build/corpus-$target" "${seeds[@]}"
