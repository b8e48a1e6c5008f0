#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes docs/strip.jpg, the image of README.md, from images of docs/: run it when they have changed. Needs oiiotool
# (openimageio-tools).
#
#   tools/strip.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../docs"
tiles=(--pattern 'constant:color=1,1,1' 1778x330 3 -d uint8)  # four of 440 pixels, and 6 between them
x=0
for picture in gallery/capsomer.jpg gallery/virus-open.jpg gallery/pour.jpg final.jpg; do
  # Cut to 4:3 about the middle.
  tiles+=("$picture" --resize 0x330 --cut '440x330+{(TOP.width-440)//2}+0' --origin +0+0 --fullpixels
    --swap --paste "+$x+0")
  x=$((x + 446))
done
# Attributes hold commands with paths.
oiiotool --nosoftwareattrib "${tiles[@]}" --eraseattrib '.*' --compression jpeg:85 -o strip.jpg
