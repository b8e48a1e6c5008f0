#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the wheel of tools/wheel.sh in a fresh virtual environment, and uses it.
#
#   wheel.sh FOLDER PROGRAM WORK_FOLDER [PYTHON]      FOLDER has the wheel; the environment has NumPy of the system
#
# PROGRAM is orrery of the same build, whose images must have the same bytes.
set -euo pipefail
wheel=$(find "$1" -name 'orrery-*.whl' 2>/dev/null) program=$(realpath "$2") work=$3 python=${4:-/usr/bin/python3}
[ -n "$wheel" ] || { echo "skipped: there is no wheel"; exit 77; }
wheel=$(realpath "$wheel")
here=$(cd "$(dirname "$0")" && pwd)
fail() {
  echo "wheel.sh: $*" >&2
  exit 1
}
rm -rf "$work"
mkdir -p "$work"
cd "$work"
"$python" -m venv --system-site-packages venv >venv.log 2>&1 || { echo "skipped: there is no python3-venv"; exit 77; }
venv/bin/pip install --no-index "$wheel" >pip.log 2>&1 || { cat pip.log; exit 1; }
unset PYTHONPATH

venv/bin/python "$here/check_python.py" . >printed
grep -qF "$PWD/venv/" printed || fail "another package was imported: $(cat printed)"
# No library of the system but those of the tag, Python's and NumPy's.
venv/bin/python - "$here/../../examples/protein/capsomer.pdb.xz" <<'END'
import re
import sys

import numpy  # noqa: F401

def loaded():
    return {line.split()[-1] for line in open("/proc/self/maps") if ".so" in line}

before = loaded()
import orrery

picture = orrery.plot(sys.argv[1], title="Capsomer", width=64, height=36, samples=4)
picture.write("plot.png", "plot.exr")
system = re.compile(r".*/(ld-linux-x86-64|lib(c|m|dl|rt|pthread|gcc_s|stdc\+\+))\.so[.\d]*|.*/lib-dynload/.*")
others = [file for file in loaded() - before if "/site-packages/orrery/" not in file and not system.fullmatch(file)]
# Python's standard modules load these on their own.
others = [file for file in others if not re.search(r"/lib(ffi|crypto|ssl|bz2|z|lzma|expat|uuid|mpdec)\.so", file)]
assert not others, f"not in the wheel: {others}"
END
# The program and its modules, too.
for file in venv/lib/python3*/site-packages/orrery/libexec/orrery/*; do
  if ldd "$file" | grep ' => /' | grep -vE "$PWD/|/(libc|libm|libdl|librt|libpthread|libgcc_s|libstdc\+\+)\.so"; then fail "$file needs a library of the system"; fi
done
small=(--set image.width=64 --set image.height=36 --samples 4 -q --reproducible)
venv/bin/orrery render "$here/../../scenes/book/final.toml" -o wheel.exr "${small[@]}"
"$program" render "$here/../../scenes/book/final.toml" -o expected.exr "${small[@]}"
cmp wheel.exr expected.exr || fail "the program of the wheel renders other bytes than the build"
venv/bin/pip uninstall -y -q orrery
left=$(find venv -iname '*orrery*')
[ -z "$left" ] || fail "left after pip uninstall: $left"
