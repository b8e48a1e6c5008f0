#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# `pip install .` in a virtual environment with Debian's scikit-build-core, as root. Uses objects that build/ has.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends python3-venv python3-pip \
  python3-scikit-build-core >/tmp/apt.log 2>&1 || { cat /tmp/apt.log; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv --system-site-packages "$work/venv"
"$work/venv/bin/pip" install --no-build-isolation --no-index -C build-dir="$root/build" "$root" >"$work/pip.log" 2>&1 ||
  { cat "$work/pip.log"; exit 1; }
cd "$work"
# expect TEXT COMMAND...: the command prints a text that contains TEXT.
expect() {
  text=$1
  shift
  printed=$("$@")
  case $printed in *"$text"*) ;; *) echo "$*: '$printed' does not contain '$text'"; exit 1 ;; esac
}
version=$(sed -n 's/^project(orrery VERSION \([0-9.]*\).*/\1/p' "$root/CMakeLists.txt")
expect '/site-packages/orrery/__init__.py' venv/bin/python "$root/tests/consumer/check_python.py" "$work"
expect "$work/venv/lib/" venv/bin/python -c 'import orrery; print(orrery.__file__)'
expect "orrery $version" venv/bin/orrery --version
expect "Version: $version" venv/bin/pip show orrery
venv/bin/pip uninstall -y -q orrery
left=$(find venv -iname '*orrery*')
if [ -n "$left" ]; then echo "left after pip uninstall: $left"; exit 1; fi
