#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Checks our EXR files with other programs: tests/compositor/tools.sh ORRERY WORK_FOLDER. Exit 77: one is missing.
set -eu
orrery=$1 work=$2
here=$(cd "$(dirname "$0")" && pwd)
for tool in oiiotool idiff exrheader exrstdattr ociocheck ociobakelut; do
  if ! command -v "$tool" >/dev/null; then
    echo "$tool is not installed; apt-get install openimageio-tools openexr opencolorio-tools"
    exit 77
  fi
done
rm -rf "$work"
mkdir -p "$work"
cd "$work"
fail() {
  echo "$1" >&2
  exit 1
}
layers=Z,depth,N,P,albedo,diffuse,specular,transmission,background,variance,samples,object_id,material_id
layers=$layers,emission,light_groups,denoise.albedo,denoise.normal,CryptoObject,CryptoMaterial
"$orrery" render "$here/bunny.toml" -q --samples 32 -o one.exr --layers "$layers" --deep deep.exr --type float
"$orrery" render "$here/bunny.toml" -q --samples 32 -o parts.exr --layers "$layers" --multipart --type float
"$orrery" render "$here/bunny.toml" -q --samples 32 -o over.exr --layers Z --set image.overscan=8

# Every program opens every file and finds the expected header attributes.
for file in one.exr parts.exr deep.exr over.exr; do
  exrheader "$file" >"$file.header" || fail "exrheader cannot read $file"
  oiiotool --hash "$file" >/dev/null || fail "oiiotool cannot read $file"
  grep -q 'worldToNDC (type m44f)' "$file.header" || fail "$file has no worldToNDC"
  grep -q 'chromaticities (type chromaticities)' "$file.header" || fail "$file has no chromaticities"
done
grep -q 'cryptomatte/3ae39a5/name (type string): "CryptoObject"' one.exr.header || fail "no Cryptomatte in one.exr"
grep -q 'name (type string): "CryptoObject"' parts.exr.header || fail "no Cryptomatte part in parts.exr"
grep -q 'type (type string): "deepscanline"' deep.exr.header || fail "deep.exr is not deep"
grep -q 'dataWindow (type box2i): (-8 -8) - (247 167)' over.exr.header || fail "wrong data window in over.exr"
exrstdattr -part 0 -string comments 'seen' one.exr copy.exr || fail "exrstdattr rejects one.exr"

# The layers sum to the beauty. idiff compares in float; the sum is exact in the order of the channels.
oiiotool one.exr --ch R,G,B -d float -o beauty.exr
lobes="diffuse_direct diffuse_indirect specular_direct specular_indirect transmission_direct transmission_indirect"
for group in "" default_; do
  sum="oiiotool one.exr --ch ${group}background.R,${group}background.G,${group}background.B"
  for lobe in $lobes; do
    sum="$sum one.exr --ch $group$lobe.R,$group$lobe.G,$group$lobe.B --add"
  done
  $sum --chnames R,G,B -d float -o sum.exr
  idiff -q -fail 0 -warn 0 sum.exr beauty.exr || fail "the sum of the layers ${group}* is not the beauty"
done
oiiotool one.exr --ch R=default.R,G=default.G,B=default.B -d float -o group.exr
idiff -q -fail 0 -warn 0 group.exr beauty.exr || fail "the only light group is not the beauty"
# A multipart file has the same pixels as a single-part one; the flattened deep image is the beauty.
oiiotool parts.exr --subimage 0 --ch R,G,B -d float -o part.exr
idiff -q -fail 0 -warn 0 part.exr beauty.exr || fail "the first part is not the beauty"
oiiotool deep.exr --flatten --ch R,G,B -d float -o flat.exr
idiff -q -fail 0.000001 -warn 0.000001 flat.exr beauty.exr || fail "the flattened deep image is not the beauty"

# The built-in OCIO config is valid.
ociocheck --iconfig "$here/../../src/display/config/orrery.ocio" >ociocheck.log || fail "ociocheck rejects the built-in config"

# The LUTs of docs/output.md, applied by oiiotool, give the images of `orrery develop`.
for view in Un-tone-mapped "ACES 1.0 SDR Video"; do
  look=
  if [ "$view" != Un-tone-mapped ]; then look=$view; fi
  ociobakelut --iconfig "$here/../../src/display/config/luts.ocio" --inputspace lin_rec709 --shaperspace shaper \
    --outputspace sRGB --looks "$look" --format resolve_cube --shapersize 65536 --cubesize 65 view.cube
  OCIO=$here/../../src/display/config/orrery.ocio oiiotool beauty.exr --ociofiletransform "$PWD/view.cube" -d uint8 -o lut.png
  "$orrery" develop beauty.exr -q -o view.png --view "$view"
  idiff -q -fail 0.012 -warn 0.012 lut.png view.png || fail "the LUT of $view differs from orrery develop"
done
echo "exrheader, exrstdattr, oiiotool, idiff, ociocheck and ociobakelut accept our files"
