#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes docs/layers.jpg: the layers of the book's final scene, side by side. Needs oiiotool (openimageio-tools).
#
#   tools/layers.sh [ORRERY]
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
orrery=${1:-$root/build/src/orrery}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"$orrery" render "$root/scenes/book/final.toml" -q -o all.exr --type float --samples 128 --width 400 --height 225 \
  --layers Z,N,P,albedo,diffuse,specular,transmission,background,object_id,variance,denoise.albedo,denoise.normal,CryptoObject

# tile NAME CHANNELS [OIIOTOOL ARGS...]
tiles=()
tile() {
  local name=$1 channels=$2
  shift 2
  oiiotool all.exr --ch "$channels" --chnames R,G,B "$@" --clamp:min=0:max=1 --powc 0.4545 -d uint8 \
    -o "$name.png"
  tiles+=("$name.png")
}
tile beauty R,G,B
for group in background diffuse_direct diffuse_indirect specular_direct specular_indirect transmission_direct transmission_indirect; do
  tile "$group" "$group.R,$group.G,$group.B"
done
tile N N.X,N.Y,N.Z --mulc 0.5 --addc 0.5
tile albedo albedo.R,albedo.G,albedo.B
tile denoise.albedo denoise.albedo.R,denoise.albedo.G,denoise.albedo.B
tile denoise.normal denoise.normal.X,denoise.normal.Y,denoise.normal.Z --mulc 0.5 --addc 0.5
tile Z Z,Z,Z --mulc 0.04
tile P P.X,P.Y,P.Z --mulc 0.1
tile variance variance.R,variance.G,variance.B --mulc 300
tile CryptoObject CryptoObject00.G,CryptoObject00.A,CryptoObject01.G
# Metadata is removed, because it contains commands with paths of this machine.
oiiotool --nosoftwareattrib "${tiles[@]}" --mosaic:pad=4 4x4 --resize 1200x0 --eraseattrib '.*' --compression jpeg:85 \
  -o "$root/docs/layers.jpg"
echo "docs/layers.jpg"
