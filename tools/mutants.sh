#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Mutation testing: introduces one numerical bug at a time (tools/mutants/table.txt) and runs the tests, which must fail. A
# mutant that survives reveals a gap in the tests. Takes 30 s to 2 minutes per mutant, so it is not part of ctest.
#
#   tools/mutants.sh [-w WORKDIR] [-p PROGRAMS] [-l] [NAME...]
#
#   NAME...   only these mutants; default: all
#   -l        list the mutants, after checking that each matches the source
#   -p "..."  run only these test programs, in this order; a survivor may still be killed by the others
#   -w DIR    keep the copy of the tree and its build in DIR, which speeds up the next run
#
# Prints a line per mutant: name | killed by | seconds. Exit status 1 if a mutant survives, does not compile or no longer
# matches the source. The test that docs/mutants.md names for a mutant runs before all others. Tests run with fewer rays
# than usual where this can be set; a mutant found in this way is also found with all rays.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
table="$root/tools/mutants/table.txt"
programs=(unit_base unit_scene unit_sky unit_denoise unit_film unit_compare unit_compile unit_kernel unit_math unit_accel unit_render unit_points unit_plot unit_data statistical numeric image)  # quickest first
export ORRERY_NUMERIC_RAYS=${ORRERY_NUMERIC_RAYS:-100000} ORRERY_FURNACE_RAYS=${ORRERY_FURNACE_RAYS:-1e6}
export ORRERY_STATISTICAL_SAMPLES=${ORRERY_STATISTICAL_SAMPLES:-4e6} ORRERY_ACCEL_RAYS=${ORRERY_ACCEL_RAYS:-100000}
hung_after_s=600  # a mutant may loop forever
judges=-StatisticalSamplers.ShiftOfAThousandthIsDetected  # needs all samples, and tests the tests, not the program

work=""
list=0
while getopts "w:p:lh" option; do
  case $option in
    w) work=$OPTARG ;;
    p) read -r -a programs <<<"$OPTARG" ;;
    l) list=1 ;;
    h) sed -n '3,17s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 0 ;;
    *) exit 2 ;;
  esac
done
shift $((OPTIND - 1))

names=() files=() before=() after=()
while IFS= read -r line; do
  case $line in
    "@ "*) read -r _ name file <<<"$line"; names+=("$name"); files+=("$file") ;;
    "< "*) before+=("${line#< }") ;;
    ">"*) line=${line#>}; after+=("${line# }") ;;
    "" | "#"*) ;;
    *) echo "mutants.sh: $table: cannot parse: $line" >&2; exit 2 ;;
  esac
done <"$table"
if [ "${#names[@]}" -ne "${#before[@]}" ] || [ "${#names[@]}" -ne "${#after[@]}" ]; then
  echo "mutants.sh: $table: every mutant needs one line each with '@', '<' and '>'" >&2
  exit 2
fi

# mutated INDEX TREE: prints the mutant's file with its edit; fails unless the edit matches exactly once.
mutated() {
  local text rest
  text=$(<"$2/${files[$1]}")
  rest=${text#*"${before[$1]}"}
  if [ "$rest" = "$text" ] || [ "${rest#*"${before[$1]}"}" != "$rest" ]; then
    echo "mutants.sh: ${names[$1]}: its text does not occur exactly once in ${files[$1]}; update tools/mutants/table.txt" >&2
    return 1
  fi
  printf '%s\n' "${text%%"${before[$1]}"*}${after[$1]}$rest"
}

chosen=()
for wanted in "$@"; do
  known=0
  for i in "${!names[@]}"; do if [ "${names[$i]}" = "$wanted" ]; then chosen+=("$i"); known=1; fi; done
  if [ "$known" -eq 0 ]; then echo "mutants.sh: no mutant named '$wanted'; -l lists all" >&2; exit 2; fi
done
if [ $# -eq 0 ]; then chosen=("${!names[@]}"); fi

"$root/tools/mutants/stale.py" "$@"
if [ "$list" -eq 1 ]; then
  for i in "${chosen[@]}"; do printf '%-36s %s\n' "${names[$i]}" "${files[$i]}"; done
  exit 0
fi

if [ -z "$work" ]; then
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
fi
rm -rf "$work/tree"  # a kept tree may contain deleted files
mkdir -p "$work/tree"
(cd "$root" && tar -cf - --exclude=./.git --exclude='./build*' --exclude=./out .) | tar -xf - -C "$work/tree"
# A kept build may contain a mutant of the last run, newer than the original file: rebuild these files.
(cd "$work/tree" && touch "${files[@]}")
# Only one instruction set is compiled, in a third of the time, if the processor has it. Mutants of code for another one
# then survive: ORRERY_MUTANTS_ISA=all.
isas=${ORRERY_MUTANTS_ISA:-avx2}
if ! grep -qw avx2 /proc/cpuinfo 2>/dev/null; then isas=all; fi
launcher=()
if command -v ccache >/dev/null; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
# -O1 gives the same bits (tools/one-hash.sh) in half the build time.
cmake -S "$work/tree" -B "$work/build" -G Ninja "${launcher[@]}" "-DORRERY_ISAS=$isas" -DCMAKE_CXX_FLAGS_RELEASE="-O1 -DNDEBUG" \
  >"$work/configure.log" 2>&1 || { cat "$work/configure.log" >&2; exit 1; }

# path_of PROGRAM
path_of() {
  if [ -d "$work/build/tests/$1" ]; then echo "$work/build/tests/$1/$1"; else echo "$work/build/tests/$1"; fi
}

# failure_in PROGRAM FILTER: builds the program and runs the tests; prints the first failure, or nothing.
failure_in() {
  local output status=0
  if ! cmake --build "$work/build" --target "$1" -j "${ORRERY_MUTANTS_JOBS:-2}" >"$work/build.log" 2>&1; then
    echo "DOES NOT COMPILE"
    grep -m 5 -E 'error|FAILED' "$work/build.log" >&2 || tail -n 5 "$work/build.log" >&2
    return
  fi
  output=$(timeout "$hung_after_s" "$(path_of "$1")" --gtest_fail_fast --gtest_filter="$2" 2>&1) || status=$?
  if [ "$status" -eq 0 ]; then return; fi
  # A crash prints no result: report the test that was running.
  { grep -oE '^\[  FAILED  \] [A-Za-z]+\.[A-Za-z0-9]+' <<<"$output" || grep -E '^\[ RUN ' <<<"$output" | tail -n 1; } |
    awk -v status="$status" 'NR == 1 { print $NF (status > 1 ? " (status " status ")" : "") }'
}

# killer [NAME]: prints the first failure of all programs, or nothing. The test that found the mutant NAME before comes first.
killer() {
  local found test program
  test=$(awk -F' *[|] *' -v name="${1:-}" 'name != "" && $2 == name { split($3, words, " "); print words[1] }' "$root/docs/mutants.md")
  program=$(awk -v suite="${test%.*}" '$1 == suite { print $2; exit }' "$work/suites")
  if [ -n "$program" ]; then
    found=$(failure_in "$program" "$test")
    if [ -n "$found" ]; then echo "$found"; return; fi
  fi
  for program in "${programs[@]}"; do
    found=$(failure_in "$program" "$judges")
    if [ -n "$found" ]; then echo "$found"; return; fi
  done
}

touch "$work/suites"
found=$(killer)
if [ -n "$found" ]; then
  echo "mutants.sh: a test fails without any mutant: $found; logs are in $work" >&2
  trap - EXIT
  exit 1
fi

for program in "${programs[@]}"; do
  "$(path_of "$program")" --gtest_list_tests | sed -n "s/^\([A-Za-z]*\)\.$/\1 $program/p"
done >"$work/suites"

printf '| mutant | killed by | seconds |\n|---|---|---|\n'
killed=0 survivors=() broken=()
for i in "${chosen[@]}"; do
  file="$work/tree/${files[$i]}"
  start=$SECONDS
  cp -p "$file" "$work/original"
  mutated "$i" "$root" >"$file"
  found=$(killer "${names[$i]}")
  cp "$work/original" "$file"  # with a new date, so that it is rebuilt
  printf '| %s | %s | %d |\n' "${names[$i]}" "${found:-**SURVIVED**}" $((SECONDS - start))
  case $found in
    "") survivors+=("${names[$i]}") ;;
    "DOES NOT COMPILE") broken+=("${names[$i]}") ;;
    *) killed=$((killed + 1)) ;;
  esac
done
echo
echo "$killed of ${#chosen[@]} killed${survivors[*]:+; survived: ${survivors[*]}}${broken[*]:+; do not compile: ${broken[*]}}"
if [ "$killed" -ne "${#chosen[@]}" ]; then exit 1; fi
