#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs missing packages, builds, and runs orrery with the given arguments. Without arguments it renders the final
# scene of the book into out/.
#
#   ./run.sh
#   ./run.sh render scenes/book/17-hollow-glass.toml -o glass.png
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$root/tools/setup.sh"

install_missing "$root/tools/packages-build.txt"
# An existing configuration, for example that of test.sh, is kept.
if [ ! -f "$root/build/.configured-with" ]; then configure -DBUILD_TESTING=OFF; fi
build 5 orrery

orrery="$root/build/src/orrery"
if [ $# -gt 0 ]; then exec "$orrery" "$@"; fi

mkdir -p "$root/out"
say "Rendering scenes/book/final.toml ..."
"$orrery" render "$root/scenes/book/final.toml" -o "$root/out/final.exr" -o "$root/out/final.png"
say "Image for display:            $root/out/final.png"
say "Scene-linear EXR:             $root/out/final.exr"
