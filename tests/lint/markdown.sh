#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tools/markdown.pl accepts good Markdown and reports each defect.
set -euo pipefail
tool=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# expect STATUS MESSAGE CONTENT
expect() {
  printf "$3" > "$folder/page.md"
  local status=0 output
  output=$("$tool" "$folder/page.md" 2>&1) || status=$?
  if [ "$status" != "$1" ] || [[ $output != *"$2"* ]]; then
    printf 'exit status %s, expected %s with "%s":\n%s\n' "$status" "$1" "$2" "$output" >&2
    exit 1
  fi
}

expect 0 '' '| a | b |\n|---|---|\n| 1 | 2 |\n\n```sh\necho "| a |---|"\n```\n\n* a list\n  ```\n  text\n  ```\n'
expect 1 'page.md:1: the separator row' 'A table: | a | b | |---|---| | 1 | 2 |\n'
expect 1 'page.md:1: the separator row' '| a | b | |---|---| | 1 | 2 |\n'
expect 1 'page.md:1: text after the language' '```toml [[points]] file = "pour.dump"\nradius = 1\n```\n'
expect 1 'page.md:3: text after the language' '```toml\nradius = 1\n``` and more\n'
expect 1 'page.md:3: the code block is not closed' 'text\n\n```toml\nradius = 1 ```\n'
expect 1 'page.md:2: the last line does not end' 'text\ntext'
