#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Measures and prints every figure that docs/numerics.md guarantees, with the test behind it. Fails if a test fails.
# Requires a build with tests in build/ (ORRERY_BUILD selects another build folder).
#
#   tools/figures.sh           as many rays as in ./test.sh; takes one or two minutes
#   tools/figures.sh --long    as in docs/numerics.md: 1e7 rays per regime, 1e9 in the furnace, 1e8 with Embree and with
#                              the list, 1e9 vertices; takes an hour or more
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${ORRERY_BUILD:-$root/build}
if [ "${1:-}" = --long ]; then
  export ORRERY_NUMERIC_RAYS=10000000 ORRERY_FURNACE_RAYS=1e9 ORRERY_ACCEL_RAYS=1e8
  export ORRERY_LIT_SAMPLES=4096 ORRERY_LIGHT_VERTICES=1e9
fi
status=0

# figure WHAT PROGRAM FILTER: runs tests; prints their verdict and output.
figure() {
  local output verdict=held start=$SECONDS
  output=$("$build/tests/$2" --gtest_filter="$3" 2>&1) || verdict="MISSED"
  if [ "$verdict" != held ]; then status=1; fi
  printf '%-72s %s, %d s\n' "$1" "$verdict" $((SECONDS - start))
  if [ "$verdict" = held ]; then
    grep -vE '^(\[|Running main|Note: |$)' <<<"$output" || true
  else
    printf '%s\n' "$output"
  fi
}

figure "hit or miss, hit point and distance against 113 and 320 bits" numeric/numeric 'Extremes.HitOrMissAndHitPointError'
figure "the book's formula must fail the same test" numeric/numeric 'Extremes.BookFormulaFails'
figure "grey furnace, radii 1e-12 .. 1e12: no self-intersection" numeric/numeric 'ExtremeScenes.GreySphereNeverHitsItself'
figure "rods: hit or miss, hit point, normal and distance against 113 and 320 bits" numeric/numeric 'Rods.HitOrMissAndHitPointError'
figure "grey furnaces of rods, alone and in contact: exactly one half" unit_render 'RenderRods.GreyRodsInAWhiteFurnaceAreHalf'
figure "contacts at gaps of 1e-13 radii or more" numeric/numeric 'Extremes.RaysAcrossNarrowGapsHit'
figure "points of textures, exact and fast" unit_kernel 'KernelTexture.CellsOfCheckers*:KernelTexture.LanesAndPrecisionsAgree'
figure "white furnaces" numeric/numeric 'ExtremeScenes.*-*GreySphereNeverHitsItself'
figure "Embree against the list: ids and distances" unit_accel 'AccelAccel.EmbreeAndListFindTheSameHits'
figure "scenes scaled by 2^-60 .. 2^48: the same bits" unit_render 'RenderRender.SceneScaleChangesNoBits'
figure "threads, tiles, shards, lanes, traversals: the same bits" unit_render 'RenderRender.*SameBits:RenderPasses.*SameBits*'
figure "a shell of negative radius is a sphere of the inverse index" unit_render 'RenderRender.NegativeRadius*'
figure "an albedo wrong by 0.1 % is detected" statistical/statistical 'StatisticalClosedForm.AlbedoError*'
figure "samplers against their distributions" statistical/statistical 'StatisticalSamplers.*'
figure "irradiance of sphere lights, in full and cut by the horizon" unit_compile 'KernelLights.IrradianceOfASphere*'
figure "light tree: 1e6 emitters; error against choosing by power" unit_compile 'CompileLightTree.FortyEight*:KernelLights.TheTree*'
figure "a ball in an emissive shell" unit_render 'RenderLitLoop.*InAnEmissiveShell*'
figure "penumbra of an eclipse, variance of a small lamp" unit_render 'RenderDirectLight.TheEclipses*:RenderDirectLight.ASmallLamp*'
figure "direct light of a vertex" unit_render 'RenderDirectLight.NoVertex*'
figure "mis, bsdf and light agree; a texel as a sun" statistical/statistical 'StatisticalDirectLight.A*'
echo
"$build/src/orrery" bench "$root/scenes/book/final.toml" --quiet
exit "$status"
