#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Renders the images of docs/gallery.md with the commands in it, and counts the defaults that they override: a default that
# figures override is wrong.
#
#   tools/gallery.sh DATA [NAME...]    DATA: folder with the data files that the page names; tools/lammps/ makes some
#                                      NAME: images to render, e.g. virus; default: all
#
# ORRERY is the program; default: build/src/orrery, which ./run.sh builds.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
program=$(realpath "${ORRERY:-$root/build/src/orrery}")
data=${1:?usage: tools/gallery.sh DATA [NAME...]}
shift
data=$(realpath "$data")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/bin"
ln -s "$program" "$work/bin/orrery"
PATH="$work/bin:$PATH"

# The commands of an image are the code block below its heading `## NAME: ...`.
commands_of() {
  awk -v name="$1" '/^## /{found = ($2 == name ":")} /^```/{inside = found && !inside; next} inside' "$root/docs/gallery.md"
}

sed -n '/^```sh/,/^```/p' "$root/docs/gallery.md" | grep -oE -e '--(look-from|map|material|style)\b' | sort | uniq -c |
  awk '{ count += $1; print $2 ": " $1 } END { print "overridden defaults: " count + 0 ", at most 4, each with a reason" }'

names=("$@")
if [ ${#names[@]} -eq 0 ]; then mapfile -t names < <(sed -n 's/^## \([a-z-]*\):.*/\1/p' "$root/docs/gallery.md"); fi
mkdir -p "$root/docs/gallery"
for name in "${names[@]}"; do
  echo "$name"
  mkdir "$work/$name"
  for file in "$data"/*; do ln -s "$file" "$work/$name/"; done
  commands_of "$name" > "$work/$name.sh"
  if ! [ -s "$work/$name.sh" ]; then
    echo "gallery.sh: docs/gallery.md has no image $name" >&2
    exit 2
  fi
  (cd "$work/$name" && bash -euo pipefail "$work/$name.sh")
  if [ -f "$work/$name/$name.gif" ]; then
    cp "$work/$name/$name.gif" "$root/docs/gallery/"
    continue
  fi
  # Less detail than orrery writes, for pages that load quickly.
  # Attributes hold the command with its paths.
  oiiotool --nosoftwareattrib "$work/$name/$name.jpg" --eraseattrib ".*" --compression jpeg:70 \
    -o "$root/docs/gallery/$name.jpg"
done
