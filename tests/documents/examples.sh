#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the commands of each example at a smaller size, and compares what they make with the picture on its page.
#
#   tests/documents/examples.sh PROGRAM WORK_FOLDER [PYTHON PACKAGE_FOLDER]
#
# Without Python, the examples that need it are left out.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
parts=$root/tests/documents
ORRERY=$(realpath "$1")
work=$2
python=${3:-}
export ORRERY PYTHONPATH=${4:+$(realpath "$4")} PYTHONDONTWRITEBYTECODE=1
rm -rf "$work"
mkdir -p "$work/bin" "$work/examples"
ln -s "$parts/orrery.sh" "$work/bin/orrery"
ln -s "$root/scenes" "$work/scenes"
if [ -n "$python" ]; then ln -s "$python" "$work/bin/python3"; fi
export PATH="$work/bin:$PATH"

# Root mean square difference of display values, 0 to 1, of both pictures reduced to 24 x 14 pixels: noise and the size of
# text differ with the size of an image. Another colour map or view differs by 0.068 or more, the right ones by 0.035 or
# less.
limit=0.045

status=0
for folder in "$root"/examples/*/; do
  name=$(basename "$folder")
  picture=$(sed -n 's/^!\[.*\](\([a-z]*\)\.jpg)$/\1/p' "$folder/README.md" 2>/dev/null || true)
  if [ -z "$picture" ] || [ "$name" = cpp ]; then continue; fi # the test `consumer` builds that one
  if [ -z "$python" ] && grep -q '\.py' "$folder/README.md"; then continue; fi
  cp -r "$folder" "$work/examples/$name"
  cd "$work/examples/$name"
  awk -f "$parts/commands.awk" README.md | cut -f 2- | tr '\001' '\n' | sed -E -f "$parts/rules.sed" > commands.sh
  divisor=6
  if grep -q -e --scale-bar commands.sh; then divisor=2; fi # text has a smallest size
  if ! ORRERY_DIVISOR=$divisor bash -euo pipefail commands.sh > log 2>&1; then
    printf '%s: a command failed\n' "$name"
    tail -n 5 log
    status=1
    continue
  fi
  oiiotool "$picture.png" --ch R,G,B --resize:filter=box 24x14 -o made.tif "$picture.jpg" --ch R,G,B --resize:filter=box 24x14 -o shown.tif
  rmse=$("$ORRERY" compare made.tif shown.tif --json | sed -n 's/.*"rmse": *\([0-9.e-]*\).*/\1/p')
  printf '%s: difference %s\n' "$name" "$rmse"
  if ! awk -v d="$rmse" -v limit="$limit" 'BEGIN { exit !(d != "" && d < limit) }'; then
    printf '%s: the commands do not make examples/%s/%s.jpg\n' "$name" "$name" "$picture"
    status=1
  fi
done
exit "$status"
