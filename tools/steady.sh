#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks that no test depends on the speed of the machine: runs the built tests several times on two processors of an
# idle machine, on two processors with four busy processes, and on a single processor. Prints a table of the runs. Exit
# status 1 if a test failed.
#
#   tools/steady.sh [--idle N] [--busy N] [--single N] [--build DIR] [CTEST_ARGUMENT ...]
#
#   --idle N     N runs without other load (the script only prints the load)
#   --busy N     N runs with four busy processes pinned to the same two processors
#   --single N   N runs pinned to one processor
#   --build DIR  build folder; default: build
#
# Default: three idle, three busy and one single run. Further arguments are passed to ctest; default: `-LE slow`.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
usage() {
  sed -n '3,15s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2
  exit 2
}

declare -A runs=()
build=$root/build
while [ $# -gt 0 ]; do
  case $1 in
    --idle | --busy | --single)
      [[ ${2:-} =~ ^[0-9]+$ ]] || usage
      runs[${1#--}]=$2
      shift 2 ;;
    --build)
      [ -d "${2:-}" ] || usage
      build=$2
      shift 2 ;;
    -h | --help) usage ;;
    *) break ;;
  esac
done
if [ ${#runs[@]} -eq 0 ]; then runs=([idle]=3 [busy]=3 [single]=1); fi
if [ $# -eq 0 ]; then set -- -LE slow; fi

# processors: prints the processors that this shell may use, one per line (expands "0-3,8").
processors() {
  local range
  for range in $(taskset -cp $$ | sed 's/.*: //; s/,/ /g'); do seq "${range%-*}" "${range#*-}"; done
}
mapfile -t allowed < <(processors)
one=${allowed[0]}
two=$one${allowed[1]:+,${allowed[1]}}

work=$(mktemp -d)
busy=()
stop_busy() {
  if [ ${#busy[@]} -gt 0 ]; then kill "${busy[@]}" 2>/dev/null || true; fi
  busy=()
}
trap 'stop_busy; rm -rf "$work"' EXIT

# attribute NAME FILE: prints an attribute of the <testsuite> in a JUnit file.
attribute() { sed -n "/^[[:space:]]*$1=\"/{s/^[[:space:]]*$1=\"\([0-9]*\)\".*/\1/p;q}" "$2"; }

status=0
table=$work/table
printf '| machine | run | load before | passed | failed | skipped | wall, s |\n|---|---|---|---|---|---|---|\n' >"$table"
# run_once KIND NUMBER PROCESSORS PARALLEL ARGUMENT...
run_once() {
  local kind=$1 number=$2 where=$3 parallel=$4 junit=$work/$1-$2.xml begin=$SECONDS load all failed skipped
  shift 4
  load=$(cut -d' ' -f1 /proc/loadavg)
  printf '%s, run %s ...\n' "$kind" "$number" >&2
  taskset -c "$where" ctest --test-dir "$build" --no-tests=error --parallel "$parallel" --output-on-failure --quiet \
    --output-junit "$junit" "$@" >"$work/log" 2>&1 || status=1
  if [ ! -s "$junit" ]; then
    cat "$work/log" >&2
    exit 2
  fi
  all=$(attribute tests "$junit") failed=$(attribute failures "$junit")
  skipped=$(($(attribute skipped "$junit") + $(attribute disabled "$junit")))
  printf '| %s | %s | %s | %s | %s | %s | %s |\n' "$kind" "$number" "$load" $((all - failed - skipped)) "$failed" \
    "$skipped" $((SECONDS - begin)) >>"$table"
  if [ "$failed" -ne 0 ]; then
    sed -n 's/.*<testcase name="\([^"]*\)".*status="fail".*/  \1/p' "$junit" >>"$work/failures"
    sed -n '/<system-out>/,/<\/system-out>/p' <(sed -n '/status="fail"/,/<\/testcase>/p' "$junit") >&2
  fi
}

for ((i = 1; i <= ${runs[idle]:-0}; ++i)); do run_once idle $i "$two" 2 "$@"; done
if [ "${runs[busy]:-0}" -gt 0 ]; then
  for _ in 1 2 3 4; do
    taskset -c "$two" sh -c 'while :; do :; done' &
    busy+=($!)
  done
  for ((i = 1; i <= runs[busy]; ++i)); do run_once busy $i "$two" 2 "$@"; done
  stop_busy
fi
for ((i = 1; i <= ${runs[single]:-0}; ++i)); do run_once single $i "$one" 1 "$@"; done
cat "$table"
if [ -s "$work/failures" ]; then
  printf 'Failed:\n'
  sort "$work/failures" | uniq -c
fi
exit "$status"
