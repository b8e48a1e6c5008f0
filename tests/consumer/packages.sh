#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Installs the Debian packages in a folder, uses each, and removes them. For a bare Debian root, as root: what a package
# needs and does not depend on is missing there.
#
#   packages.sh FOLDER
set -eu
here=$(cd "$(dirname "$0")" && pwd)
packages=$1
install() { DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@" >/tmp/apt.log 2>&1 || { cat /tmp/apt.log; exit 1; }; }
fail() { echo "packages.sh: $*" >&2; exit 1; }

apt-get update -qq
install "$packages"/orrery_*.deb
cd /tmp
orrery render "$here/../scenes/book/final.toml" -q -o first.exr -o first.png \
  --set image.width=160 --set image.height=90 --set render.samples=16
test -s first.exr && test -s first.png
test -s /usr/share/man/man1/orrery.1.gz
if dpkg -L orrery | grep stubs; then fail "the package orrery has stub libraries"; fi

install "$packages"/python3-orrery_*.deb
printed=$(python3 "$here/check_python.py" /tmp)
case $printed in 'x y z /usr/lib/python3/dist-packages/orrery/'*) ;; *) fail "import orrery: $printed" ;; esac

install "$packages"/liborrery-dev_*.deb g++ cmake ninja-build
if dpkg -L liborrery-dev | grep -E 'toml_tree\.h|-inl\.h|liborrery_cli'; then fail "liborrery-dev contains internals"; fi
cmake -S "$here" -B build -G Ninja -DCMAKE_BUILD_TYPE=Release "-DEXAMPLE=$here/../examples/cpp" >cmake.log 2>&1 || { cat cmake.log; exit 1; }
cmake --build build >build.log 2>&1 || { cat build.log; exit 1; }
build/consumer
python3 "$here/check_sbom.py" /usr

apt-get purge -y -qq orrery python3-orrery liborrery-dev >/tmp/apt.log 2>&1
left=$(find / -xdev -iname '*orrery*' -not -path '/orrery*' -not -path '/proc/*' -not -path '/tmp/*' -not -path "$HOME/.cache/*")
[ -z "$left" ] || fail "left after removal: $left"
