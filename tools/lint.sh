#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks the source without building it: C++ formatting (clang-format 14, as in Debian 12), scripts (shellcheck), the
# licence line of every file, and mutants. Exit status: 0 no findings, 1 findings, 77 a tool is missing.
#
#   tools/lint.sh           prints findings
#   tools/lint.sh --fix     formats the C++ first
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

format=""
for name in clang-format-14 clang-format; do
  if command -v "$name" >/dev/null && [[ $("$name" --version) == *' version 14.'* ]]; then format=$name; break; fi
done
if [ -z "$format" ]; then echo "lint.sh: skipped: clang-format 14 not found" >&2; exit 77; fi
if ! command -v shellcheck >/dev/null; then echo "lint.sh: skipped: shellcheck not found" >&2; exit 77; fi

status=0
mapfile -t sources < <(git ls-files '*.cpp' '*.h')
mapfile -t scripts < <(git ls-files '*.sh' .ci/run)
if ! git rev-parse --is-inside-work-tree >/dev/null 2>&1; then echo "lint.sh: skipped: not a git repository" >&2; exit 77; fi
if [ "${1:-}" = --fix ]; then "$format" -i "${sources[@]}"; fi
"$format" --dry-run -Werror "${sources[@]}" || status=1
shellcheck -S warning -x -e SC1091 "${scripts[@]}" || status=1
for file in "${sources[@]}" "${scripts[@]}" $(git ls-files '*.py' '*.cmake' '*CMakeLists.txt'); do
  if [[ $(head -n 3 "$file") != *'SPDX-License-Identifier: Apache-2.0'* ]]; then
    echo "$file: no SPDX-License-Identifier in the first three lines" >&2
    status=1
  fi
done
if grep -rnE 'ImageInput::open|ImageBuf|ImageCache' src; then
  echo "lint.sh: stub libraries stand for some formats of OpenImageIO; name one of ours in ImageInput::create" >&2
  status=1
fi
# With pipefail, a command that stops reading early makes the one before it fail (SIGPIPE) if that still writes.
if grep -nE '[|] *(head|grep -[a-zA-Z]*q)\b' "${scripts[@]}"; then
  echo "lint.sh: a pipe into head or grep -q fails at random with pipefail; use awk, or read the output into a variable" >&2
  status=1
fi
# tools/gallery.sh runs the commands of each image of the gallery, and expects them to write it.
if ! awk -F '[ :]' '
    function check() { if (name != "" && !(shows && writes)) { print FILENAME ": " name ": " (shows ? "no command writes" : "the page does not show") " it"; bad = 1 } }
    /^## / { check(); name = $2; shows = writes = 0 }
    index($0, "](gallery/" name ".jpg)") || index($0, "](gallery/" name ".gif)") { shows = 1 }
    /^```/ { inside = !inside }
    inside && (index($0, "-o " name ".jpg") || index($0, "-o " name ".gif")) { writes = 1 }
    END { check(); exit bad }' docs/gallery.md >&2; then status=1; fi
# A source is tested by a file of its name.
while IFS= read -r source; do
  name=${source#src/} && name=${name%.cpp}
  files=("tests/unit/${name}_test.cpp")
  case $name in cli/* | submit/*) files+=("tests/cli/${name##*/}_test.cpp" "tests/batch/${name##*/}_test.cpp") ;; esac
  tests=$(git ls-files "${files[@]}")
  if [ -z "$tests" ]; then
    echo "$source: there is no ${files[0]}" >&2
    status=1
  fi
done < <(git ls-files ':(glob)src/*/*.cpp' ':!src/python')
# Mutants that no longer match the source would be missed until the next release.
tools/mutants/stale.py || status=1
exit "$status"
