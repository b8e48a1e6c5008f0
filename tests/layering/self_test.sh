#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# The layering test must be able to fail: trees with one violation each, and what it says about them.
set -eu
here=$(dirname "$0")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
printf '# a comment\nlow | | | open/\nmiddle | low | lib/ | \nhigh | middle | | \n' >"$work/rooms.txt"

tree() { # a right tree
  rm -rf "$work/src"
  mkdir -p "$work/src/low" "$work/src/middle" "$work/src/high"
  printf '#include <open/x.h>\nnamespace orrery::low {}\n' >"$work/src/low/a.h"
  printf '#include <lib/x.h>\n#include "low/a.h"\nnamespace orrery::middle {}\n' >"$work/src/middle/inner.h"
  printf 'namespace orrery::middle {}\n' >"$work/src/middle/door.h"
  printf '#include "middle/inner.h"\n#include "middle/door.h"\nnamespace orrery::middle {}\n' >"$work/src/middle/b.cpp"
  printf '#include "middle/door.h"\nnamespace orrery::high {}\n' >"$work/src/high/c.h"
}
check() { sh "$here/check.sh" "$work/rooms.txt" "$work/src"; }
# must_say TEXT: the check fails and says so.
must_say() {
  if said=$(check); then
    echo "not found: $1"
    exit 1
  fi
  case $said in
    *"$1"*) ;;
    *) echo "looked for: $1"; echo "said: $said"; exit 1 ;;
  esac
}

tree; check
tree; printf '#include "high/c.h"\nnamespace orrery::low {}\n' >"$work/src/low/a.h"; must_say 'low may not include high/c.h'
tree; printf '  #  include "low/a.h"\nnamespace orrery::high {}\n' >"$work/src/high/c.h"; must_say 'high may not include low/a.h'
tree; printf '#include <lib/x.h>\nnamespace orrery::low {}\n' >"$work/src/low/a.h"; must_say 'low may not use lib/x.h'
tree; printf '#include <other/x.h>\nnamespace orrery::low {}\n' >"$work/src/low/a.h"; must_say 'other/x.h is of a library that no room names'
tree; printf '#include "middle/inner.h"\nnamespace orrery::high {}\n' >"$work/src/high/c.h"; must_say 'middle/inner.h brings lib/x.h'
tree; printf '#include "middle/inner.h"\nnamespace orrery::middle {}\n' >"$work/src/middle/door.h"; must_say 'middle/door.h brings lib/x.h'
tree; printf 'namespace orrery::high {}\n' >"$work/src/low/a.h"; must_say 'opens a namespace that is not its room'
tree; printf 'namespace orrery {}\n' >"$work/src/low/a.h"; must_say 'opens a namespace that is not its room'
tree; printf 'int lost;\n' >"$work/src/low/a.h"; must_say 'opens no namespace orrery::low'
tree; mkdir "$work/src/util"; printf 'namespace orrery::util {}\n' >"$work/src/util/a.h"; must_say 'is in no room'
