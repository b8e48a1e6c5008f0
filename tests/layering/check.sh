#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Holds every #include and namespace under a source folder against the table of rooms.
#
#   check.sh ROOMS.txt SRC
#
# ROOMS.txt has a line a room: name | rooms it may include | prefixes of foreign headers that stay within it | prefixes
# of foreign headers that its own headers may show to others. A room that another one includes is not included with it:
# whoever uses it names it.
set -eu
awk -v src="$2" '
  function trim(s) { gsub(/^ +| +$/, "", s); return s }
  function complain(file, text) { printf "%s: %s\n", file, text; bad = 1 }
  function room_of(path) { sub(/\/.*/, "", path); return path }
  # The foreign prefix that a header begins with, or nothing.
  function foreign_of(header,   prefix) {
    for (prefix in foreign) if (index(header, prefix) == 1) return prefix
    return ""
  }

  BEGIN { FS = "|" }
  /^#/ { next }
  NF >= 4 {
    room = trim($1); rooms[room] = 1; room_count++
    n = split(trim($2), d, " "); for (i = 1; i <= n; i++) may[room, d[i]] = 1
    n = split(trim($3), f, " "); for (i = 1; i <= n; i++) { foreign[f[i]] = 1; allowed[room, f[i]] = 1 }
    n = split(trim($4), f, " "); for (i = 1; i <= n; i++) { foreign[f[i]] = 1; allowed[room, f[i]] = 1; shown[room, f[i]] = 1 }
  }

  function check_file(path,   file, room, line, header, prefix, opened) {
    file = src "/" path
    room = room_of(path)
    if (!(room in rooms)) { complain(file, "is in no room"); return }
    while ((getline line < file) > 0) {
      if (match(line, /^[ \t]*#[ \t]*include[ \t]*[<"][^>"]+/)) {
        header = substr(line, RSTART, RLENGTH); sub(/^[^<"]*[<"]/, "", header)
        includes[++include_count] = path " " header
        prefix = foreign_of(header)
        if (room_of(header) in rooms) {
          if (room_of(header) != room && !((room, room_of(header)) in may)) complain(file, room " may not include " header)
        } else if (prefix != "") {
          if (!((room, prefix) in allowed)) complain(file, room " may not use " header)
          else if (!((room, prefix) in shown)) internal[path] = header
        } else if (header ~ /\// && header !~ /^(sys|linux)\//) {
          complain(file, header " is of a library that no room names")
        }
      }
      if (line ~ /^#[ \t]*define ORRERY_/) opened = 1  # a macro lives in no namespace
      if (line ~ /^[ \t]*(inline )?namespace orrery/) {
        opened = 1
        if (line !~ "^namespace orrery::" room "[: {]") complain(file, "opens a namespace that is not its room: " line)
      }
    }
    close(file)
    if (!opened && path !~ /main\.cpp$/) complain(file, "opens no namespace orrery::" room)
  }

  END {
    if (room_count == 0) { print "no rooms in the table"; exit 1 }
    command = "find " src " -type f \\( -name \"*.h\" -o -name \"*.cpp\" -o -name \"*.in\" \\)"
    while ((command | getline file) > 0) { file_count++; check_file(substr(file, length(src) + 2)) }
    if (file_count == 0) { print "no source files under " src; exit 1 }

    # A header that includes an internal one is internal itself, and neither is for another room.
    do {
      grown = 0
      for (i = 1; i <= include_count; i++) {
        split(includes[i], pair, " ")
        if (!(pair[2] in internal) || pair[1] in internal) continue
        if (room_of(pair[1]) == room_of(pair[2])) { internal[pair[1]] = internal[pair[2]]; grown = 1 }
        else complained[pair[1], pair[2]] = 1
      }
    } while (grown)
    for (key in complained) {
      split(key, pair, SUBSEP)
      complain(src "/" pair[1], pair[2] " brings " internal[pair[2]] " and is not for other rooms")
    }
    exit bad
  }' "$1"
