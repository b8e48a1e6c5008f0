#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs clang-tidy with the checks of .clang-tidy. Exit status: 0 no findings, 1 findings, 77 a tool is missing.
#
#   tools/tidy.sh              lines that differ from the main branch (on the main branch: from the previous commit)
#   tools/tidy.sh REVISION     lines that differ from REVISION
#   tools/tidy.sh FILE...      all lines of these files
#   tools/tidy.sh --all        all lines of all files; takes about an hour of CPU time
#
# A header is checked in one translation unit: the source of the same name, or the first source that includes it.
#
# ORRERY_BUILD a configured build folder; default: build, if it is configured and not a unity build, else build-tidy,
# which is created ORRERY_TIDY_MINUTES time limit: files not started by then are listed and not checked; default: none
# ORRERY_TIDY_JOBS parallel processes; default: one per core
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

skip() {
  echo "tidy.sh: skipped: $*" >&2
  exit 77
}

# Findings differ between versions; Debian 12 has 14.
tidy=""
for name in clang-tidy-14 clang-tidy; do
  if command -v "$name" >/dev/null && [[ $("$name" --version) == *' version 14.'* ]]; then tidy=$name; break; fi
done
[ -n "$tidy" ] || skip "clang-tidy 14 not found (package clang-tidy-14)"
git rev-parse --is-inside-work-tree >/dev/null 2>&1 || skip "not a git repository"

build=${ORRERY_BUILD:-build}
if [ -z "${ORRERY_BUILD:-}" ] && ! awk '/^CMAKE_UNITY_BUILD:.*=ON/ { exit 1 }' build/CMakeCache.txt 2>/dev/null; then
  build="build-tidy"
fi
commands=$build/compile_commands.json
if [ ! -f "$commands" ]; then
  options=(-DCMAKE_EXPORT_COMPILE_COMMANDS=ON)
  if [ ! -f "$build/CMakeCache.txt" ]; then options+=(-G Ninja -DORRERY_BENCH=ON); fi
  mkdir -p "$build"
  cmake -S . -B "$build" "${options[@]}" >"$build/configure.log" 2>&1 || { cat "$build/configure.log" >&2; exit 1; }
fi

# base_revision: the commit where this branch left the main branch.
base_revision() {
  local head branch base
  head=$(git rev-parse HEAD)
  for branch in origin/main origin/master main master; do
    base=$(git merge-base HEAD "$branch" 2>/dev/null) || continue
    if [ "$base" != "$head" ]; then echo "$base"; return; fi
  done
  git rev-parse --verify --quiet HEAD~1 || echo "$head"
}

# changed_lines REVISION: clang-tidy's line filter for the lines that were added since REVISION.
changed_lines() {
  git diff -U0 --diff-filter=d --no-color --no-ext-diff "$1" -- '*.cpp' '*.h' | awk '
    /^\+\+\+ b\// { file = substr($0, 7) }
    /^@@/ {
      split(substr($3, 2), range, ",")
      count = range[2] == "" ? 1 : range[2]
      if (count > 0) lines[file] = lines[file] (lines[file] == "" ? "" : ",") "[" range[1] "," range[1] + count - 1 "]"
    }
    END {
      printf "["
      for (file in lines) printf "%s{\"name\":\"/%s\",\"lines\":[%s]}", (n++ ? "," : ""), file, lines[file]
      printf "]"
    }'
}

is_compiled() { grep -qF "\"file\": \"$PWD/$1\"" "$commands"; }

# unit_of FILE: the translation unit in which FILE is checked, or nothing.
unit_of() {
  local candidate header
  if is_compiled "$1"; then echo "$1"; return; fi
  case $1 in *.h) ;; *) return 0 ;; esac
  candidate=${1%.h}
  candidate=${candidate%-inl}.cpp
  if is_compiled "$candidate"; then echo "$candidate"; return; fi
  header=${1#src/}
  header=${header#tests/}
  while IFS= read -r candidate; do
    if is_compiled "$candidate"; then echo "$candidate"; return; fi
  done < <(git grep -lF "#include \"$header\"" -- '*.cpp')
}

line_filter=""
case ${1:-} in
  --all) mapfile -t files < <(git ls-files '*.cpp') ;;
  *.cpp | *.h) files=("$@") ;;
  *)
    base=${1:-$(base_revision)}
    git rev-parse --verify --quiet "$base^{commit}" >/dev/null || { echo "tidy.sh: unknown revision $base" >&2; exit 2; }
    mapfile -t files < <(git diff --name-only --diff-filter=d "$base" -- '*.cpp' '*.h')
    line_filter=$(changed_lines "$base")
    ;;
esac
mapfile -t units < <(for file in "${files[@]}"; do unit_of "$file"; done | sort -u)
if [ "${#units[@]}" -eq 0 ] || [ "$line_filter" = "[]" ]; then echo "tidy.sh: no files to check" >&2; exit 0; fi
echo "tidy.sh: checking ${#units[@]} translation units" >&2

# check_one FILE: prints the findings; fails if there are any. GCC's compile commands have warning options that Clang
# does not know.
check_one() {
  local output options=(-p "$build" --quiet --extra-arg=-Wno-unknown-warning-option)
  if [ "$(date +%s)" -ge "$deadline" ]; then echo "tidy.sh: out of time, not checked: $1" >&2; return 0; fi
  if [ -n "$line_filter" ]; then options+=("--line-filter=$line_filter"); fi
  if output=$("$tidy" "${options[@]}" "$1" 2>&1); then return 0; fi
  grep -vE '^[0-9]+ warnings?( and [0-9]+ errors?)? generated' <<<"$output"
  return 1
}
deadline=$(($(date +%s) + 60 * ${ORRERY_TIDY_MINUTES:-100000}))
export tidy build deadline line_filter
export -f check_one
# shellcheck disable=SC2016  # expanded by the inner shell
printf '%s\0' "${units[@]}" | xargs -0 -n 1 -P "${ORRERY_TIDY_JOBS:-$(nproc)}" bash -c 'check_one "$1"' _ || exit 1
