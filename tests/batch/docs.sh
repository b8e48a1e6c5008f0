#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Runs the commands of docs/batch.md verbatim on a small scene and checks their output files.
#
#   tests/batch/docs.sh PROGRAM WORK_FOLDER
set -eu
[ $# -eq 2 ] || { sed -n '3,6s/^# \{0,1\}//p' "$0"; exit 2; }
root=$(cd "$(dirname "$0")/../.." && pwd)
program=$(realpath "$1")
rm -rf "$2"
mkdir -p "$2/bin"
cd "$2"
ln -s "$program" bin/orrery
PATH=$PWD/bin:$PATH
export PATH
{
  printf '[animation]\nturntable = 48\n[image]\nwidth = 96\nheight = 54\n[render]\nsamples = 16\n'
  sed -n '/^\[camera\]/,$p' "$root/scenes/book/final.toml" | sed '/^\[render\]/,/^$/d'
} > shot.toml
orrery check shot.toml

commands=$(sed -n '/^## Five commands/,/^## Frames/p' "$root/docs/batch.md" | sed -n '/^```sh/,/^```/p' | grep -v '^```')
[ "$(printf '%s\n' "$commands" | grep -c '^orrery ')" = 6 ] || { echo "docs: docs/batch.md does not have six commands"; exit 1; }
command -v parallel > /dev/null || {
  echo "docs: GNU parallel is not installed; its script is generated but not run"
  commands=$(printf '%s\n' "$commands" | sed 's/ && sh job.sh//')
}
printf '%s\n' "$commands" | while read -r line; do
  sh -c "$line" > last.log 2>&1 || { echo "docs: command failed: $line"; cat last.log; exit 1; }
done

orrery render shot.toml -o one.exr --set render.samples=64 --reproducible -q
orrery compare whole.exr one.exr -q --fail-above max=0
[ -s whole.png ] && [ -s shot.0004.exr ] && grep -q sbatch farm.sh
if command -v parallel > /dev/null; then orrery compare p.0003.exr shot.0003.exr -q --fail-above max=0; fi
echo "docs: all commands of docs/batch.md work as documented"
