#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the Debian packages, the archive and the wheel of HEAD twice, in clones with different folders, time zones and
# locales and without a compiler cache, and compares them. Takes about twelve minutes on two cores. Exit status: 0 identical, 1 different.
#
# KEEP=1   keep the packages and print their folder
set -euo pipefail
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
work=$(mktemp -d "${TMPDIR:-/var/tmp}/orrery-reproducible.XXXXXX")
cleanup() { if [ -n "${KEEP:-}" ]; then echo "kept in $work"; else rm -rf "$work"; fi; }
trap cleanup EXIT
unset CMAKE_CXX_COMPILER_LAUNCHER

# build CLONE PACKAGES
build() {
  git clone -q "$repository" "$1"
  "$1/tools/packages.sh" "$2/deb"
  "$1/tools/portable.sh" "$2"
  "$1/tools/wheel.sh" "$2"
  rm -rf "$1"
}
TZ=UTC LC_ALL=C.UTF-8 build "$work/one" "$work/packages-1"
TZ=Pacific/Kiritimati LC_ALL=C build "$work/the second folder/with a longer path" "$work/packages-2"
cd "$work"
sha256sum packages-*/*.* packages-*/deb/*.deb
if ! diff -r packages-1 packages-2; then
  echo "The packages differ; diffoscope (Debian package diffoscope-minimal) shows where." >&2
  exit 1
fi
echo "The packages of both builds are identical."
