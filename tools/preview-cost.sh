#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Prints what `orrery render --preview` costs, in percent of the processor time of the render: the preview's thread, and
# the copies that the rendering threads make. It compares samples of perf, which do not depend on other load. The image
# must be the same as without a preview.
#
#   tools/preview-cost.sh FILE.png [SCENE [OPTION ...]]
#
# The default scene is the cover of the book at 600 x 338.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
file=${1:?usage: tools/preview-cost.sh FILE.png [SCENE [OPTION ...]]}
scene=${2:-scenes/book/final.toml}
if [ $# -gt 2 ]; then options=("${@:3}"); else options=(--width 600 --height 338 --samples 100); fi
orrery=${ORRERY:-build/src/orrery}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

render() { "${@:2}" "$orrery" render "$scene" -q --reproducible "${options[@]}" -o "$work/$1.exr" "${preview[@]}"; }
preview=()
render without env
preview=(--preview "$file")
render with perf record -q -F 2000 -o "$work/samples" --
cmp "$work/without.exr" "$work/with.exr"
perf report -i "$work/samples" --no-children -g none -s comm,symbol --stdio 2> /dev/null | awk '
  /^ *[0-9.]+%/ {
    percent = $1 + 0
    total += percent
    if ($2 == "preview") thread += percent
    else if (/Sums::mean|Canvas::write|__floattidf/) copies += percent
  }
  END { printf "preview thread %.2f %%, copies %.2f %%, together %.2f %%\n", 100 * thread / total, 100 * copies / total,
               100 * (thread + copies) / total }'
