#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Prints every figure that docs/numerics.md promises, each measured now by the test behind it, and fails if one of them is
# missed. Wants a build with tests in build/ (ORRERY_BUILD for another).
#
#   tools/figures.sh           the length of the tests, a minute or two
#   tools/figures.sh --long    the length that is promised: 1e7 rays in each regime, 1e9 in the furnace, 1e8 by Embree and
#                              by the list; a quarter of an hour and more
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${ORRERY_BUILD:-$root/build}
if [ "${1:-}" = --long ]; then
  export ORRERY_NUMERIC_RAYS=10000000 ORRERY_FURNACE_RAYS=1e9 ORRERY_ACCEL_RAYS=1e8
fi
status=0

# figure WHAT PROGRAM FILTER: what the tests print, and their verdict.
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

figure "hit or miss, hit point, distance, against 113 and 320 bits" numeric/numeric 'Extremes.HitOrMissAndHitPointError'
figure "the book's formula before the same judge, which must find it guilty" numeric/numeric 'Extremes.TheBooksFormulaFailsThem'
figure "grey furnace, radii 1e-12 .. 1e12: no self-hit" numeric/numeric 'ExtremeScenes.AGreySphereNeverHitsItself'
figure "contacts at gaps of 1e-13 radii and more" numeric/numeric 'Extremes.NoContactIsLost'
figure "white furnaces" numeric/numeric 'ExtremeScenes.*-*AGreySphereNeverHitsItself'
figure "Embree against the list, id and distance" unit_accel 'AccelAccel.EmbreeFindsExactlyWhatTheListFinds'
figure "scaled by 2^-60 .. 2^48: the same bits" unit_render 'RenderRender.TheSizeOfTheWorldChangesNoBit'
figure "threads, tiles, shards, lanes, traversals: the same bits" unit_render 'RenderRender.*SameBits:RenderTiles.*:RenderTraversals.AllGiveTheSameBits'
figure "hollow glass by negative radius is the inverse index" unit_render 'RenderRender.AShellOfNegativeRadius*'
figure "an albedo wrong by 0.1 %" statistical/statistical 'StatisticalClosedForm.AnAlbedoWrong*'
figure "samplers against their distributions" statistical/statistical 'StatisticalSamplers.*'
echo
"$build/src/orrery" bench "$root/scenes/book/final.toml" --quiet
exit "$status"
