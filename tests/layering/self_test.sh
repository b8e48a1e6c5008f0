#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Runs the layering test on trees with one violation each and checks that it fails with the right message.
set -eu
here=$(dirname "$0")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
printf '# a comment\nlow | | | open/\nmiddle | low | lib/ | \nhigh | middle | | \n' >"$work/rooms.txt"

tree() { # a valid tree
  rm -rf "$work/src"
  mkdir -p "$work/src/low" "$work/src/middle" "$work/src/high"
  printf '#include <open/x.h>\nnamespace orrery::low {}\n' >"$work/src/low/a.h"
  printf '#include <lib/x.h>\n#include "low/a.h"\nnamespace orrery::middle {}\n' >"$work/src/middle/inner.h"
  printf 'namespace orrery::middle {}\n' >"$work/src/middle/door.h"
  printf '#include "middle/inner.h"\n#include "middle/door.h"\nnamespace orrery::middle {}\n' >"$work/src/middle/b.cpp"
  printf '#include "middle/door.h"\nnamespace orrery::high {}\n' >"$work/src/high/c.h"
}
check() { sh "$here/check.sh" "$work/rooms.txt" "$work/src"; }
# must_say TEXT: expects the check to fail with a message that contains TEXT.
must_say() {
  if said=$(check); then
    echo "passed, but should report: $1"
    exit 1
  fi
  case $said in
    *"$1"*) ;;
    *) echo "expected: $1"; echo "reported: $said"; exit 1 ;;
  esac
}

tree; check
tree; printf '#include "high/c.h"\nnamespace orrery::low {}\n' >"$work/src/low/a.h"; must_say 'low may not include high/c.h'
tree; printf '  #  include "low/a.h"\nnamespace orrery::high {}\n' >"$work/src/high/c.h"; must_say 'high may not include low/a.h'
tree; printf '#include <lib/x.h>\nnamespace orrery::low {}\n' >"$work/src/low/a.h"; must_say 'low may not use lib/x.h'
tree; printf '#include <other/x.h>\nnamespace orrery::low {}\n' >"$work/src/low/a.h"; must_say 'other/x.h belongs to a library that no room declares'
tree; printf '#include <curl.h>\nnamespace orrery::low {}\n' >"$work/src/low/a.h"; must_say 'curl.h belongs to a library that no room declares'
tree; printf '#include <unistd.h>\n#include <vector>\nnamespace orrery::low {}\n' >"$work/src/low/a.h"; check
tree; printf '#include "middle/inner.h"\nnamespace orrery::high {}\n' >"$work/src/high/c.h"; must_say 'middle/inner.h includes lib/x.h'
tree; printf '#include "middle/inner.h"\nnamespace orrery::middle {}\n' >"$work/src/middle/door.h"; must_say 'middle/door.h includes lib/x.h'
tree; printf 'namespace orrery::high {}\n' >"$work/src/low/a.h"; must_say 'opens a namespace of another room'
tree; printf 'namespace orrery {}\n' >"$work/src/low/a.h"; must_say 'opens a namespace of another room'
tree; printf 'int lost;\n' >"$work/src/low/a.h"; must_say 'does not open namespace orrery::low'
tree; mkdir "$work/src/util"; printf 'namespace orrery::util {}\n' >"$work/src/util/a.h"; must_say 'is not in a room of the table'
