#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the container image of the archive with buildah, without a network, and runs it.
#
#   container.sh ARCHIVE WORK_FOLDER
set -euo pipefail
[ -f "$1" ] || { echo "skipped: there is no archive"; exit 77; }
command -v buildah >/dev/null || { echo "skipped: buildah not found"; exit 77; }
archive=$(realpath "$1") work=$2
here=$(cd "$(dirname "$0")" && pwd)
rm -rf "$work"
mkdir -p "$work/context" "$work/data"
cd "$work"
tar xf "$archive" -C context --strip-components=1
store=(--root "$work/storage" --runroot "$work/run" --storage-driver vfs)
buildah "${store[@]}" bud --isolation chroot -t orrery context >build.log 2>&1 ||
  { tail -n 3 build.log; echo "skipped: buildah cannot build here"; exit 77; }
container=$(buildah "${store[@]}" from orrery)
entry=$(buildah "${store[@]}" inspect --format '{{index .OCIv1.Config.Entrypoint 0}}' "$container")
cp "$here/../../examples/protein/capsomer.pdb.xz" data
buildah "${store[@]}" run --isolation chroot -v "$work/data:/data" "$container" -- "$entry" plot capsomer.pdb.xz \
  -o image.png --title Capsomer --width 64 --height 36 -q
[ -s data/image.png ]
