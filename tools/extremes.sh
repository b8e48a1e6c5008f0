#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Renders scenes/extremes into one image: a row per scene, with the precisions exact, fast and book side by side.
#
#   tools/extremes.sh [out/extremes.png]
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
output=${1:-$root/out/extremes.png}
orrery=${ORRERY:-$root/build/src/orrery}
command -v oiiotool >/dev/null || { echo "extremes.sh: oiiotool not found; install openimageio-tools" >&2; exit 1; }
mkdir -p "$(dirname "$output")"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

pictures=()
rows=0
for scene in "$root"/scenes/extremes/*.toml; do
  for precision in exact fast book; do
    picture="$work/$(basename "$scene" .toml)-$precision.png"
    "$orrery" render "$scene" -o "$picture" --precision "$precision" -q
    pictures+=("$picture")
  done
  rows=$((rows + 1))
done
# Without metadata the same images give the same file.
oiiotool "${pictures[@]}" --mosaic:pad=4 "3x$rows" --eraseattrib ".*" -o "$output"
echo "$output"
