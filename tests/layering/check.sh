#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Checks every #include and namespace under a source folder against the table of rooms.
#
#   check.sh ROOMS.txt SRC
#
# ROOMS.txt has one line per room: name | rooms it may include | include prefixes of libraries used internally | include
# prefixes of libraries that its headers may expose to other rooms. Dependencies are not transitive: a room lists every
# room that it includes.
set -eu
awk -v src="$2" '
  function trim(s) { gsub(/^ +| +$/, "", s); return s }
  function complain(file, text) { printf "%s: %s\n", file, text; bad = 1 }
  function room_of(path) { sub(/\/.*/, "", path); return path }
  # Returns the library prefix of a header, or nothing.
  function foreign_of(header,   prefix) {
    for (prefix in foreign) if (index(header, prefix) == 1) return prefix
    return ""
  }

  BEGIN {
    FS = "|"
    split("dirent.h dlfcn.h fcntl.h locale.h malloc.h netdb.h poll.h pthread.h signal.h spawn.h termios.h time.h unistd.h", p, " ")
    for (i in p) posix[p[i]] = 1
  }
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
    if (!(room in rooms)) { complain(file, "is not in a room of the table"); return }
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
        } else if (header !~ /^(sys|linux|arpa|netinet)\// && (header ~ /\// || (header ~ /\.h/ && !(header in posix)))) {
          complain(file, header " belongs to a library that no room declares")
        }
      }
      if (line ~ /^#[ \t]*define ORRERY_/) opened = 1  # macros have no namespace
      if (line ~ /^[ \t]*(inline )?namespace orrery/) {
        opened = 1
        if (line !~ "^namespace orrery::" room "[: {]") complain(file, "opens a namespace of another room: " line)
      }
    }
    close(file)
    if (!opened && path !~ /main\.cpp$/) complain(file, "does not open namespace orrery::" room)
  }

  END {
    if (room_count == 0) { print "the table has no rooms"; exit 1 }
    command = "find " src " -type f \\( -name \"*.h\" -o -name \"*.cpp\" -o -name \"*.in\" \\)"
    while ((command | getline file) > 0) { file_count++; check_file(substr(file, length(src) + 2)) }
    if (file_count == 0) { print "no source files under " src; exit 1 }

    # A header that includes an internal header is internal; other rooms may not include internal headers.
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
      complain(src "/" pair[1], pair[2] " includes " internal[pair[2]] ", so other rooms may not include it")
    }
    exit bad
  }' "$1"
