#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what is missing, builds, and runs orrery with the given arguments; without any it renders the book's final
# scene into out/.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$root/tools/setup.sh"

install_missing "$root/tools/packages-build.txt"
[ -f "$root/build/.configured-with" ] || configure -DBUILD_TESTING=OFF
build orrery

orrery="$root/build/src/orrery"
if [ $# -gt 0 ]; then exec "$orrery" "$@"; fi
mkdir -p "$root/out"
"$orrery" render "$root/scenes/book/final.toml" -o "$root/out/final.exr" -o "$root/out/final.png"
say "The pictures are out/final.png, to look at, and out/final.exr, to go on with."
