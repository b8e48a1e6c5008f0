#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Stands in for orrery where commands of documents are tested: the same command with a smaller image, fewer particles
# and less time.
#
# ORRERY          the program
# ORRERY_DIVISOR  divides width, height and the width of outlines; default: 8
set -euo pipefail
divisor=${ORRERY_DIVISOR:-8}

smaller() { echo $(($1 / divisor > 16 ? $1 / divisor : 16)); }
# value OPTION VALUE: the value in place of a large one.
value() {
  case $1 in
    --width | --height) smaller "$2" ;;
    --outline) awk -v px="$2" -v divisor="$divisor" 'BEGIN { print px / divisor }' ;;
    --count) echo $(($2 < 20000 ? $2 : 20000)) ;;
    --samples) echo $(($2 < 64 ? $2 : 64)) ;;
    --time) echo 1s ;;
    --budget) echo 30s ;; # more than any study of a small scene needs, on a busy machine
    *) echo "$2" ;;
  esac
}

words=() has_width=false
while [ $# -gt 0 ]; do
  case $1 in
    --open) ;; # a browser
    --width | --height | --outline | --count | --samples | --time | --budget)
      if [ "$1" = --width ]; then has_width=true; fi
      words+=("$1" "$(value "$1" "$2")")
      shift
      ;;
    *) words+=("$1") ;;
  esac
  shift
done
case ${words[0]:-} in
  plot) if ! $has_width; then words+=(--width "$(smaller 1920)" --height "$(smaller 1080)"); fi ;;
  render) if ! $has_width; then words+=(--width 96 --height 54); fi ;;
  study) if ! $has_width; then words+=(--width 48 --height 27); fi ;;
  view)
    # Until it serves the page; then a signal ends it. INT is ignored in the background.
    address=$(mktemp)
    trap 'rm -f "$address"' EXIT
    "$ORRERY" "${words[@]}" >"$address" &
    while kill -0 $! 2>/dev/null && ! [ -s "$address" ]; do sleep 0.1; done
    kill -TERM $!
    wait $!
    exit
    ;;
esac
exec "$ORRERY" "${words[@]}"
