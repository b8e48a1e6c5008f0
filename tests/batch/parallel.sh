#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Runs the script of `orrery submit --parallel` with GNU parallel: one shard fails, then reruns complete the frames.
#
#   tests/batch/parallel.sh PROGRAM WORK_FOLDER
#
# Exit status 77 if GNU parallel is not installed.
set -eu
[ $# -eq 2 ] || { sed -n '3,7s/^# \{0,1\}//p' "$0"; exit 2; }
scenes=$(cd "$(dirname "$0")/../../scenes" && pwd)
program=$(realpath "$1")
command -v parallel > /dev/null || { echo "parallel: skipped: GNU parallel is not installed"; exit 77; }
rm -rf "$2"
mkdir -p "$2"
cd "$2"

settings="--width 200 --height 112 --samples 60 --set animation.turntable=48 --reproducible"
cp "$scenes/book/final.toml" 'a shot.toml'
# shellcheck disable=SC2086  # words
"$program" submit 'a shot.toml' -o shot.####.exr -o shot.%02d.png --frames 1-3x2 --shards 3 --parallel 2 $settings \
  --set 'material.ground.albedo=[0.5, 0.4, 0.5]' --program "$program" > shot.sh

# A folder with the name of a shard file makes that task fail; the script must report it.
mkdir -p 'shot.____.exr.shards/3.2.shard.exr'
if sh shot.sh 2> first.log; then echo "parallel: a shard failed, but the script succeeded"; exit 1; fi
[ "$(awk 'NR > 1 && $7 != 0' shot.____.exr.shards/render.log | wc -l)" = 1 ] || { cat shot.____.exr.shards/render.log; exit 1; }
rmdir 'shot.____.exr.shards/3.2.shard.exr'
sh shot.sh 2> second.log
sh shot.sh 2> third.log  # nothing left to render

for frame in 1 3; do
  # shellcheck disable=SC2086
  "$program" render 'a shot.toml' -o one.exr -o one.png --frames $frame $settings -q \
    --set 'material.ground.albedo=[0.5, 0.4, 0.5]'
  cmp one.exr "shot.000$frame.exr"
  cmp one.png "shot.0$frame.png"
done
echo "parallel: two frames in three shards each, one shard failed at first: the same bytes as a single process"
