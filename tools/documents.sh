#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the commands of all pages on a clean clone of HEAD and prints those that fail. Images are smaller than on the page,
# and small files stand in for data files that are not part of the repository.
#
#   tools/documents.sh [PAGE...]      default: README.md, the pages of docs/, scenes/ and examples/
#
# ORRERY is the program; default: build/src/orrery; the Python package is that of the same build. Exit status: 0 if no
# command fails; 77 if the build has no Python package, or this is no git repository.
#
# tests/documents/ has the parts: commands.awk finds the commands, rules.sed names those that are not run and why,
# stand_ins.py writes the data, orrery.sh makes images small. The Python of docs/python.md is tested separately.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
ORRERY=$(realpath "${ORRERY:-$root/build/src/orrery}")
export ORRERY
parts=$root/tests/documents
build=$(dirname "$(dirname "$ORRERY")")
if ! git -C "$root" rev-parse HEAD >/dev/null 2>&1; then echo "skipped: $root is no git repository"; exit 77; fi
if [ ! -d "$build/lib/python3/dist-packages" ]; then echo "skipped: the build has no Python package"; exit 77; fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

git clone -q --no-hardlinks "$root" "$work/clone"
/usr/bin/python3 "$parts/stand_ins.py" "$work/data"
for name in final a b; do
  "$ORRERY" render "$work/data/scene.toml" -o "$work/data/$name.exr" --samples 4 -q
done
# The archive that the tests have made.
rules=(-f "$parts/rules.sed")
version=$(sed -n 's/^project(orrery VERSION \([0-9.]*\).*/\1/p' "$root/CMakeLists.txt")
archive=$build/tests/portable/orrery-$version-linux-x86_64.tar.xz
if [ ! -f "$archive" ]; then rules+=(-e 's/^(tar xf )?orrery-.*/not run: there is no archive/'); fi
mkdir "$work/bin"
ln -s "$parts/orrery.sh" "$work/bin/orrery"
ln -s /usr/bin/python3 "$work/bin/python3" # Debian's, which the package is built for
export PATH="$work/bin:$PATH" PYTHONPATH=$build/lib/python3/dist-packages PYTHONDONTWRITEBYTECODE=1

ran=0 failed=0 skipped=0
# run_page PAGE: runs the commands of a page, in a clone; those of an example, in its folder.
run_page() {
  local page=$1 folder="$work/page" place line command status
  git clone -q "$work/clone" "$folder"
  ln -s "$build" "$folder/build"
  place=$folder
  if [[ $page == examples/*/* ]]; then place="$folder/$(dirname "$page")"; else cp "$work/data"/* "$folder"; fi
  if [ -f "$archive" ]; then ln -s "$archive" "$place"; fi
  while IFS=$'\t' read -r line command; do
    command=$(tr '\001' '\n' <<<"$command" | sed -E "${rules[@]}")
    if [[ $command == 'not run: '* ]]; then
      printf '%s:%s: %s\n' "$page" "$line" "$command"
      skipped=$((skipped + 1))
      continue
    fi
    status=0
    (cd "$place" && timeout 120 bash -euo pipefail -c "$command") >"$work/log" 2>&1 </dev/null || status=$?
    ran=$((ran + 1))
    if [ "$status" -ne 0 ]; then
      failed=$((failed + 1))
      printf '%s:%s: status %s: %s\n' "$page" "$line" "$status" "$command"
      tail -n 3 "$work/log" | sed 's/^/    /'
    fi
  done < <(awk -f "$parts/commands.awk" "$folder/$page")
  rm -rf "$folder"
}

pages=("$@")
if [ ${#pages[@]} -eq 0 ]; then
  mapfile -t pages < <(cd "$work/clone" && ls README.md CONTRIBUTING.md docs/*.md scenes/README.md examples/README.md examples/*/README.md)
fi
for page in "${pages[@]}"; do run_page "$page"; done
printf '%s commands run, %s failed, %s not run\n' "$ran" "$failed" "$skipped"
[ "$failed" -eq 0 ]
