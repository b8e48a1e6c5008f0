#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# What can be said of the text without building it: form of the C++ (clang-format 14, which Debian 12 has), scripts
# (shellcheck), and that every file names its licence. Exit status 1 where something is found, 77 where a tool is missing.
#
#   tools/lint.sh           says what is wrong
#   tools/lint.sh --fix     brings the C++ into form first
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

format=""
for name in clang-format-14 clang-format; do
  if command -v "$name" >/dev/null && "$name" --version | grep -q ' version 14\.'; then format=$name; break; fi
done
if [ -z "$format" ]; then echo "lint.sh: left out: there is no clang-format 14" >&2; exit 77; fi
if ! command -v shellcheck >/dev/null; then echo "lint.sh: left out: there is no shellcheck" >&2; exit 77; fi

status=0
mapfile -t sources < <(git ls-files '*.cpp' '*.h')
mapfile -t scripts < <(git ls-files '*.sh' .ci/run)
if ! git rev-parse --is-inside-work-tree >/dev/null 2>&1; then echo "lint.sh: left out: no git tree" >&2; exit 77; fi
if [ "${1:-}" = --fix ]; then "$format" -i "${sources[@]}"; fi
"$format" --dry-run -Werror "${sources[@]}" || status=1
shellcheck -S warning -x -e SC1091 "${scripts[@]}" || status=1
for file in "${sources[@]}" "${scripts[@]}" $(git ls-files '*.py' '*.cmake' '*CMakeLists.txt'); do
  if ! head -n 3 "$file" | grep -q 'SPDX-License-Identifier: Apache-2.0'; then
    echo "$file: no SPDX-License-Identifier in its first lines" >&2
    status=1
  fi
done
exit "$status"
