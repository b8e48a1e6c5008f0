# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash disable=SC2154  # read by scripts that have set `root`
# Sourced by run.sh, test.sh and .ci/run, which set `root` first: installs missing packages, configures, builds. Prints
# little on success; on failure it prints the end of the log and what to do.

say() { printf '%s\n' "$*" >&2; }
die() {
  say "error: $*"
  exit 1
}

# show_log FILE: prints the last lines of a log.
show_log() {
  tail -n 60 "$1" >&2
  say "(last lines of $1)"
}

# missing_packages LIST...: prints the packages in the lists that are not installed, one per line.
missing_packages() {
  local wanted
  # One query for all packages saves time on an up-to-date machine. Unknown packages make its status 1.
  wanted=$(sed 's/#.*//' "$@")
  # shellcheck disable=SC2086  # a word is a package
  { dpkg-query -W -f '${Package} ${db:Status-Status}\n' $wanted 2>/dev/null || true; } |
    awk -v wanted="$wanted" '$2 == "installed" { have[$1] = 1 }
      END { n = split(wanted, names); for (i = 1; i <= n; ++i) if (!(names[i] in have)) print names[i] }'
}

# install_missing LIST...: installs the missing packages of the lists, if any.
install_missing() {
  if ! command -v dpkg-query >/dev/null; then
    say "Not a Debian or Ubuntu system: assuming that the packages in tools/packages-*.txt are installed."
    return 0
  fi
  local missing
  missing=$(missing_packages "$@" | tr '\n' ' ')
  if [ -z "$missing" ]; then return 0; fi

  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || die "missing packages: $missing
Install them as root (apt-get install --no-install-recommends $missing) or install sudo, then try again."
    as_root=(sudo)
  fi
  say "Installing missing packages${as_root:+ with sudo}: $missing"
  local log
  log=$(mktemp)
  # A stale index does not matter if the packages can be installed.
  "${as_root[@]}" apt-get update -qq >"$log" 2>&1 </dev/null || true
  # shellcheck disable=SC2086  # a word is a package
  if ! "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 install -y -qq \
    --no-install-recommends $missing >>"$log" 2>&1 </dev/null; then
    show_log "$log"
    die "apt-get cannot install: $missing"
  fi
  rm -f "$log"
}

# configure OPTION...: configures build/ with these CMake options, unless it is already configured with the same ones.
# Another set of instruction sets (ORRERY_ISAS) keeps the objects that are there.
# Unity builds halve the time to compile everything. ORRERY_UNITY=OFF builds as developers and distributions do.
configure() {
  local stamp="$root/build/.configured-with"
  set -- "-DORRERY_WERROR=${ORRERY_WERROR:-OFF}" "-DCMAKE_UNITY_BUILD=${ORRERY_UNITY:-ON}" "$@"
  if [ -f "$stamp" ] && [ "$(cat "$stamp")" = "$*" ]; then return 0; fi
  mkdir -p "$root/build"
  if ! cmake -S "$root" -B "$root/build" -G Ninja -DCMAKE_BUILD_TYPE=Release "$@" >"$root/build/configure.log" 2>&1; then
    show_log "$root/build/configure.log"
    die "CMake configuration failed; if $root/build is from another build, remove it and try again"
  fi
  printf '%s' "$*" >"$stamp"
}

# reconfigure OPTION...: changes options of build/, which is configured.
reconfigure() {
  if ! cmake "$@" "$root/build" >"$root/build/configure.log" 2>&1; then
    show_log "$root/build/configure.log"
    die "CMake configuration failed"
  fi
}

# use_commit_date: sets SOURCE_DATE_EPOCH, the date of all that is built, to that of the commit.
use_commit_date() {
  if [ -z "${SOURCE_DATE_EPOCH:-}" ]; then
    SOURCE_DATE_EPOCH=$(git -C "$root" log -1 --format=%ct) || die "not a git checkout: set SOURCE_DATE_EPOCH"
  fi
  export SOURCE_DATE_EPOCH
}

# release_version: prints the version; for a commit that is not tagged with it (v1.2.3), one that precedes the release.
release_version() {
  local version
  version=$(sed -n 's/^project(orrery VERSION \([0-9.]*\).*/\1/p' "$root/CMakeLists.txt")
  if [ "$(git -C "$root" describe --tags --exact-match 2>/dev/null)" != "v$version" ]; then
    version+="~git$(date -u -d "@$SOURCE_DATE_EPOCH" +%Y%m%d.%H%M%S)"
  fi
  printf '%s\n' "$version"
}

# show_progress LOG: writes Ninja's lines to LOG, and shows the percentage, the elapsed time and, from the pace so far, the
# remaining minutes: on a terminal in one line, elsewhere each quarter. A build that takes less than three seconds shows
# nothing.
show_progress() {
  local line shown=0 begin=$SECONDS
  while IFS= read -r line; do
    printf '%s\n' "$line" >&4
    local seconds=$((SECONDS - begin))
    if ! [[ "$line" =~ ^\[([0-9]+)/([0-9]+)\] ]] || [ "$seconds" -lt 3 ]; then continue; fi
    local done=${BASH_REMATCH[1]} total=${BASH_REMATCH[2]}
    local percent=$((100 * done / total)) left=$((seconds * (total - done) / (done > 0 ? done : 1)))
    local remaining=""
    if [ "$left" -gt 0 ]; then remaining=", about $(((left + 59) / 60)) min left"; fi
    if [ -t 2 ]; then
      printf '\r\033[K%3d %% %d:%02d%s' "$percent" $((seconds / 60)) $((seconds % 60)) "$remaining" >&2
    elif [ $((percent / 25)) -gt "$shown" ]; then
      shown=$((percent / 25))
      say "  $percent % after $seconds s$remaining"
    fi
  done 4>"$1"
  if [ -t 2 ] && [ $((SECONDS - begin)) -ge 3 ]; then printf '\r\033[K' >&2; fi
}

# build MINUTES TARGET: builds a target in build/. MINUTES is the time of the first build on one core, for the message.
# Sets build_seconds.
build() {
  local cpu_minutes=$1 target=$2 begin=$SECONDS
  local stamp="$root/build/.built-$target" cores
  cores=$(nproc)
  local first=0
  if [ ! -f "$stamp" ]; then
    first=1
    say "Building orrery (first time: about $(((cpu_minutes + cores - 1) / cores)) minutes) ..."
  elif [ -n "$(find "$root/src" "$root/tests" "$root/bench" "$root/cmake" "$root/CMakeLists.txt" -newer "$stamp" -print -quit)" ]; then
    say "Building changes ..."
  fi
  # Concurrent calls in one checkout take turns.
  exec 9>"$root/build/.lock"
  flock 9
  if ! NINJA_STATUS='[%f/%t] ' cmake --build "$root/build" --target "$target" 2>&1 9>&- |
    show_progress "$root/build/build.log"; then
    show_log "$root/build/build.log"
    die "the build failed; if memory ran out, try again with CMAKE_BUILD_PARALLEL_LEVEL=1 in the environment"
  fi
  exec 9>&-
  touch "$stamp"
  # shellcheck disable=SC2034  # used by the scripts that source this
  build_seconds=$((SECONDS - begin))
  if [ "$first" = 1 ]; then say "Built in $build_seconds s."; fi
}
