#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Renders scenes/thumbnails/, the images in scenes/README.md, and docs/final.jpg, of which tools/strip.sh makes a part of the
# image in README.md. Takes three or four minutes on two cores.
#   tools/thumbnails.sh [PROGRAM]     default: build/src/orrery, which ./run.sh builds
set -eu
cd "$(dirname "$0")/.."
program=${1:-build/src/orrery}
if ! command -v "$program" > /dev/null; then
  echo "thumbnails.sh: $program not found; build it with ./run.sh --version, or give its path" >&2
  exit 66
fi
out=scenes/thumbnails
mkdir -p "$out"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# picture SCENE NAME ARGUMENTS...
picture() {
  scene=$1
  name=$2
  shift 2
  echo "$name"
  "$program" render "$scene" -o "$out/$name.png" --width 240 --height 135 --quiet "$@"
}
# The book's display transforms: linear until it introduces gamma, then the square root.
linear() { name=$1; shift; picture "scenes/book/$name.toml" "$name" --set color.view=Raw "$@"; }
gamma() { name=$1; shift; picture "scenes/book/$name.toml" "$name" --set color.display="Gamma 2.0 Rec.709" --samples 1000 "$@"; }

for name in 01-gradient-sky 02-red-sphere 03-normals-one-sphere 04-normals-with-ground 05-antialiased; do
  linear $name
done
for name in 06-hemisphere-diffuse 07-child-ray-limit 08-shadow-acne 09-shadow-acne-fixed 10-lambertian; do
  linear $name --samples 400
done
picture scenes/book/07-child-ray-limit.toml 07-child-ray-limit-two --set color.view=Raw --set render.max_depth=2 --samples 400
picture scenes/book/08-shadow-acne.toml 08-shadow-acne-exact --set color.view=Raw --precision exact --samples 400
picture scenes/book/11-gamma.toml 11-gamma-linear --set color.view=Raw --samples 1000
for name in 11-gamma 12-metal 13-fuzzy-metal 14-glass-always-refracts 15-glass-total-internal-reflection \
            16-glass-schlick 17-hollow-glass 18-wide-angle-two-spheres 19-far-view 20-zoomed-view 21-defocus-blur final; do
  gamma $name
done
for name in glass defocus contrast; do
  picture "scenes/trade/$name.toml" "trade-$name" --samples 400
done
picture scenes/molecules/ethanol.toml molecules-ethanol --samples 1000
for name in three-point thousand-lamps caustic glass-in-the-sun paperweights marbles rainbow eclipse-ground eclipse-space; do
  picture "scenes/light/$name.toml" "light-$name" --samples 1000
done
picture scenes/light/eclipse-ground.toml light-eclipse-ground-fast --samples 1000 --precision fast
echo light-three-point-relit
"$program" render scenes/light/three-point.toml -o "$work/three.exr" --layers light_groups --type float --denoise \
  --width 240 --height 135 --samples 1000 --quiet
group() { echo "--ch R=$1.R,G=$1.G,B=$1.B"; }
# shellcheck disable=SC2046 # words
oiiotool "$work/three.exr" $(group default) "$work/three.exr" $(group key) --mulc 0.15,0.2,0.35 --add \
  "$work/three.exr" $(group fill) --mulc 0.5 --add "$work/three.exr" $(group rim) --mulc 3 --add \
  "$work/three.exr" --ch A --chappend -o "$work/relit.exr"
"$program" develop "$work/relit.exr" -o "$out/light-three-point-relit.png" --quiet
balls=scenes/light/grey-and-chrome.toml
picture $balls light-grey-and-chrome --samples 400
for elevation in 60 12; do
  picture $balls light-grey-and-chrome-$elevation --samples 400 --set background.sun_elevation=$elevation
done
picture $balls light-grey-and-chrome-3 --samples 400 --set background.sun_elevation=3 --set background.exposure=3
picture $balls light-grey-and-chrome-m4 --samples 1000 --set background.sun_elevation=-4 --set background.exposure=7
picture $balls light-studio --samples 400 --set "background={ type = \"image\", file = \"studio.exr\" }"
cp scenes/next-week/* "$work"
for name in 01-bouncing-spheres 02-checkered-spheres 03-planet 04-perlin-noise 05-turbulence 06-marble 07-lamp; do
  picture "$work/$name.toml" "next-week-$name" --set color.display="Gamma 2.0 Rec.709" --samples 1000
done
picture "$work/08-rough-glass.toml" next-week-08-rough-glass --samples 1000
for count in 30 1000 100000; do
  "$program" generate cloud --count $count -o "$work/cloud-$count.toml"
  picture "$work/cloud-$count.toml" cloud-$count --samples 300
done
du -ch "$out"/*.png | tail -1
echo docs/final.jpg
"$program" render scenes/book/final.toml -o docs/final.jpg --width 800 --height 450 --noise 0.01 \
  --set color.display="Gamma 2.0 Rec.709" --reproducible --quiet
