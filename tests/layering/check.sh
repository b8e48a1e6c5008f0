#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Holds every #include and namespace under a source folder against the table of rooms.
#
#   check.sh ROOMS.txt SRC
#
# ROOMS.txt has a line a room: name | rooms it may include | prefixes of foreign headers that it may include.
set -eu
awk -v src="$2" '
  function trim(s) { gsub(/^ +| +$/, "", s); return s }
  BEGIN { FS = "|" }
  NF >= 3 {
    room = trim($1); rooms[room] = 1
    n = split(trim($2), d, " "); for (i = 1; i <= n; i++) may[room, d[i]] = 1
    n = split(trim($3), f, " "); for (i = 1; i <= n; i++) { foreign[f[i]] = 1; allowed[room, f[i]] = 1 }
  }
  function complain(text) { printf "%s: %s\n", file, text; bad = 1 }
  function check_include(room, header,   first, prefix, at) {
    at = index(header, "/")
    first = at ? substr(header, 1, at - 1) : ""
    if (first in rooms) {
      if (first != room && !((room, first) in may)) complain(room " may not include " header)
      return
    }
    for (prefix in foreign)
      if (index(header, prefix) == 1 && !((room, prefix) in allowed)) complain(room " may not use " header)
  }
  END {
    if (length(rooms) == 0) { print "no rooms in the table"; exit 1 }
    command = "find " src " -name \"*.h\" -o -name \"*.cpp\" -o -name \"*.in\""
    while ((command | getline file) > 0) {
      room = substr(file, length(src) + 2); sub(/\/.*/, "", room)
      if (!(room in rooms)) { complain("is in no room"); continue }
      files++
      opened = 0
      while ((getline line < file) > 0) {
        if (match(line, /^#include [<"][^>"]+/)) check_include(room, substr(line, RSTART + 10, RLENGTH - 10))
        if (line ~ /^namespace orrery/) {
          opened = 1
          if (line !~ "^namespace orrery::" room "[: {]") complain("opens a namespace that is not its room: " line)
        }
      }
      close(file)
      if (!opened && file !~ /main\.cpp$/) complain("opens no namespace orrery::" room)
    }
    if (files == 0) { print "no source files under " src; exit 1 }
    exit bad
  }' "$1"
