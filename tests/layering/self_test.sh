#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# The layering test must be able to fail: trees with one violation each.
set -eu
here=$(dirname "$0")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
printf 'low | |\nhigh | low | lib/\n' >"$work/rooms.txt"

tree() { # a right tree
  rm -rf "$work/src"
  mkdir -p "$work/src/low" "$work/src/high"
  printf 'namespace orrery::low {}\n' >"$work/src/low/a.h"
  printf '#include <lib/x.h>\n#include "low/a.h"\nnamespace orrery::high {}\n' >"$work/src/high/b.h"
}
must_fail() {
  if sh "$here/check.sh" "$work/rooms.txt" "$work/src" >/dev/null; then
    echo "not found: $1"
    exit 1
  fi
}
tree
sh "$here/check.sh" "$work/rooms.txt" "$work/src"
tree; printf '#include "high/b.h"\nnamespace orrery::low {}\n' >"$work/src/low/a.h"; must_fail 'an include upwards'
tree; printf '#include <lib/x.h>\nnamespace orrery::low {}\n' >"$work/src/low/a.h"; must_fail 'a foreign library in the wrong room'
tree; printf 'namespace orrery::high {}\n' >"$work/src/low/a.h"; must_fail 'a namespace of another room'
tree; mkdir "$work/src/util"; printf 'namespace orrery::util {}\n' >"$work/src/util/a.h"; must_fail 'a folder that is no room'
