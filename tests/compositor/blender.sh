#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Opens our EXR files in Blender's compositor: tests/compositor/blender.sh ORRERY WORK_FOLDER
set -eu
orrery=$1 work=$2
here=$(cd "$(dirname "$0")" && pwd)
if ! command -v blender >/dev/null; then
  echo "blender is not installed; apt-get install blender"
  exit 77
fi
rm -rf "$work"
mkdir -p "$work"
layers=Z,N,P,albedo,diffuse,variance,samples,object_id,denoise.albedo,CryptoObject
"$orrery" render "$here/bunny.toml" -q -o "$work/single.exr" --layers "$layers"
"$orrery" render "$here/bunny.toml" -q -o "$work/multipart.exr" --layers "$layers" --multipart
status=0
blender --background --factory-startup --python-exit-code 1 --python "$here/blender.py" -- "$work" \
  >"$work/log" 2>&1 || status=$?
grep -v '^Fra:\|^Saved:' "$work/log" || true
exit $status
