#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Breaks the numerics on purpose, one bug at a time (tools/mutants/table.txt), and asks the tests to notice each. A bug
# that no test notices is a hole in the tests. Takes half a minute to two minutes a bug, so it is no part of ctest.
#
#   tools/mutants.sh [-w WORKDIR] [-p PROGRAMS] [-l] [NAME...]
#
#   NAME...   only these mutants; without names all
#   -l        lists the mutants, after checking that each still fits the source
#   -p "..."  asks only these test programs, in this order; what survives them may still die by the others
#   -w DIR    keeps the copy of the tree and its build there, which makes the next run quick
#
# Prints a line a mutant: name | what killed it | seconds. Exit status 1 if one survives, does not compile or no longer
# fits the source: a mutant that rots is an error, not a pass. Fewer rays than in the tests are used where a test lets
# them be set; what is found so is found with all of them too.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
table="$root/tools/mutants/table.txt"
programs=(unit_film unit_metrics unit_compile unit_kernel unit_math unit_accel unit_render statistical numeric image)  # quickest first
export ORRERY_NUMERIC_RAYS=${ORRERY_NUMERIC_RAYS:-100000} ORRERY_FURNACE_RAYS=${ORRERY_FURNACE_RAYS:-1e6}
export ORRERY_STATISTICAL_SAMPLES=${ORRERY_STATISTICAL_SAMPLES:-4e6} ORRERY_ACCEL_RAYS=${ORRERY_ACCEL_RAYS:-100000}
hung_after_s=600  # a mutant may loop for ever
judges=-StatisticalSamplers.AShiftOfAThousandthIsFound  # needs all samples, and judges the tests, not the program

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
    *) echo "mutants.sh: $table: not understood: $line" >&2; exit 2 ;;
  esac
done <"$table"
if [ "${#names[@]}" -ne "${#before[@]}" ] || [ "${#names[@]}" -ne "${#after[@]}" ]; then
  echo "mutants.sh: $table: every mutant needs one line '@', one '<' and one '>'" >&2
  exit 2
fi

# mutated INDEX TREE: the text of the mutant's file with its one edit; fails where the edit does not fit exactly once.
mutated() {
  local text rest
  text=$(<"$2/${files[$1]}")
  rest=${text#*"${before[$1]}"}
  if [ "$rest" = "$text" ] || [ "${rest#*"${before[$1]}"}" != "$rest" ]; then
    echo "mutants.sh: ${names[$1]}: its text does not stand exactly once in ${files[$1]}; bring tools/mutants/table.txt up to date" >&2
    return 1
  fi
  printf '%s\n' "${text%%"${before[$1]}"*}${after[$1]}$rest"
}

chosen=()
for wanted in "$@"; do
  known=0
  for i in "${!names[@]}"; do if [ "${names[$i]}" = "$wanted" ]; then chosen+=("$i"); known=1; fi; done
  if [ "$known" -eq 0 ]; then echo "mutants.sh: no mutant is called '$wanted'; -l lists them" >&2; exit 2; fi
done
if [ $# -eq 0 ]; then chosen=("${!names[@]}"); fi

rotten=0
for i in "${chosen[@]}"; do mutated "$i" "$root" >/dev/null || rotten=$((rotten + 1)); done
if [ "$list" -eq 1 ]; then for i in "${chosen[@]}"; do printf '%-36s %s\n' "${names[$i]}" "${files[$i]}"; done; fi
if [ "$rotten" -gt 0 ]; then echo "mutants.sh: $rotten no longer fit" >&2; exit 1; fi
if [ "$list" -eq 1 ]; then exit 0; fi

if [ -z "$work" ]; then
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
fi
rm -rf "$work/tree"  # a kept one may hold files that are no more
mkdir -p "$work/tree"
(cd "$root" && tar -cf - --exclude=./.git --exclude=./build --exclude=./out .) | tar -xf - -C "$work/tree"
# A kept build may hold a mutant of the last run, newer than the true file: build those files again.
(cd "$work/tree" && touch "${files[@]}")
# One instruction set instead of three, where this processor has it: built in a third of the time.
if grep -qw avx2 /proc/cpuinfo 2>/dev/null; then
  printf 'set(ORRERY_SIMD -march=x86-64-v3 -maes -mpclmul "-DHWY_DISABLED_TARGETS=(HWY_AVX2-1)")\n' \
    >>"$work/tree/cmake/OrreryRoom.cmake"
fi
launcher=()
if command -v ccache >/dev/null; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
# -O1: the same bits (tools/one-hash.sh), built in half the time.
cmake -S "$work/tree" -B "$work/build" -G Ninja "${launcher[@]}" -DCMAKE_CXX_FLAGS_RELEASE="-O1 -DNDEBUG" \
  >"$work/configure.log" 2>&1 || { cat "$work/configure.log" >&2; exit 1; }

# killer: builds and runs one program after the other; prints what failed first, or nothing.
killer() {
  local program path output status
  for program in "${programs[@]}"; do
    if ! cmake --build "$work/build" --target "$program" -j "${ORRERY_MUTANTS_JOBS:-2}" >"$work/build.log" 2>&1; then
      echo "DOES NOT COMPILE"
      return
    fi
    path="$work/build/tests/$program"
    if [ -d "$path" ]; then path="$path/$program"; fi
    status=0
    output=$(timeout "$hung_after_s" "$path" --gtest_fail_fast --gtest_filter="$judges" 2>&1) || status=$?
    if [ "$status" -eq 0 ]; then continue; fi
    # A crash prints no verdict: the test that was running counts.
    { grep -oE '^\[  FAILED  \] [A-Za-z]+\.[A-Za-z0-9]+' <<<"$output" || grep -E '^\[ RUN ' <<<"$output" | tail -n 1; } |
      awk -v status="$status" 'NR == 1 { print $NF (status > 1 ? " (status " status ")" : "") }'
    return
  done
}

found=$(killer)
if [ -n "$found" ]; then
  echo "mutants.sh: the tests fail without any mutant: $found; log in $work" >&2
  trap - EXIT
  exit 1
fi

printf '| mutant | killed by | seconds |\n|---|---|---|\n'
killed=0 survivors=() broken=()
for i in "${chosen[@]}"; do
  file="$work/tree/${files[$i]}"
  start=$SECONDS
  cp -p "$file" "$work/original"
  mutated "$i" "$root" >"$file"
  found=$(killer)
  cp "$work/original" "$file"  # with a new date, so that it is built again
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
