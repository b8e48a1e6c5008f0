#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the Debian packages orrery, liborrery-dev and python3-orrery of this checkout.
#
#   tools/packages.sh [FOLDER]    default: build/packages
#
# Packages of a commit that is not tagged with its version (v1.2.3) have a version that precedes the release
# (1.2.3~git...). Dates are those of the commit: the packages of a commit are the same in every build on the same system
# (tools/reproducible.sh). They have no stub libraries (docs/decisions/0021).
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$root/tools/setup.sh"
umask 022
folder=$(realpath -m -- "${1:-$root/build/packages}")

use_commit_date
install_missing "$root/tools/packages-build.txt" "$root/tools/packages-debian.txt"
# The build of test.sh serves as well.
if ! grep -qs '^ORRERY_PYTHON:BOOL=ON' "$root/build/CMakeCache.txt"; then
  configure -DBUILD_TESTING=OFF -DORRERY_PYTHON=ON
fi
trap 'reconfigure -DORRERY_STUBS=ON' EXIT # for the next user of the build
reconfigure -DORRERY_STUBS=OFF -DORRERY_ISAS=all
build 10 all
rm -rf "$folder"
if ! cpack -G DEB --config "$root/build/CPackConfig.cmake" -D "CPACK_PACKAGE_VERSION=$(release_version)" -B "$folder" \
  >"$root/build/packages.log" 2>&1; then
  show_log "$root/build/packages.log"
  die "cpack failed"
fi
rm -rf "$folder/_CPack_Packages"
ls "$folder"/*.deb
