#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Makes stub libraries: files that stand in for libraries behind those of a module that none of our formats uses
# (docs/decisions/0021). They and what they load take most of the time in which OpenImageIO is loaded, and most of its
# space.
#
#   cmake/stub-libraries.sh FOLDER COMPILER UNUSED LIBRARY...
#
# UNUSED is an extended regular expression of the names after `lib`, among those that a LIBRARY needs. A stub has the
# soname of the library and defines the symbols that the libraries need from it. Of its functions, only constructors of
# static objects are called, and those that return a version, when OpenImageIO lists its formats; so functions return a
# pointer to zeros. A library that is not found has no stub.
set -eu
[ $# -ge 4 ] || { sed -n '3,13s/^# \{0,1\}//p' "$0"; exit 2; }
folder=$1 compiler=$2 unused=$3
shift 3
export LC_ALL=C

rm -rf "$folder"
mkdir -p "$folder"
nm --dynamic --undefined-only "$@" | sed 's/.* //; s/@.*//' > "$folder/needed"
for soname in $(objdump -p "$@" | sed -n 's/^ *NEEDED *//p' | sort -u | grep -E "^lib($unused)\.so(\.|\$)"); do
  path=$("$compiler" -print-file-name="$soname")
  [ -f "$path" ] || continue
  # Lines of nm: address, size (not of all symbols), type, and name@@version.
  nm --dynamic --defined-only --print-size "$path" | awk -v needed="$folder/needed" -v versions="$folder/versions" '
    BEGIN {
      while ((getline name < needed) > 0) is_needed[name] = 1
      print "static char zeros[4096];"
    }
    {
      split($NF, symbol, "@@")
      if (!(symbol[1] in is_needed)) next
      if ($(NF - 1) ~ /[TWi]/) print "void* " symbol[1] "(void) { return zeros; }"
      else print "char " symbol[1] "[0x" $2 "];"
      if (symbol[2] != "") names[symbol[2]] = names[symbol[2]] symbol[1] "; "
    }
    END {
      for (version in names) print version " { global: " names[version] "};" > versions
      if (version == "") print "{ global: *; };" > versions
    }' > "$folder/stub.c"
  # From standard input, so that the file does not name a folder. Debian expects that every library needs libc.
  "$compiler" -x c -w -fno-builtin -O1 -fPIC -shared -s -Wl,-soname,"$soname" -Wl,--version-script="$folder/versions" \
    -nodefaultlibs -Wl,--no-as-needed -lc -o "$folder/$soname" - < "$folder/stub.c"
done
rm -f "$folder/needed" "$folder/versions" "$folder/stub.c"
