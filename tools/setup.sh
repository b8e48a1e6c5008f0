# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash disable=SC2154  # read by scripts that have set `root`
# Sourced by run.sh and test.sh, which set `root` first: installs what is missing, configures, builds. Quiet about what
# succeeds; where something fails it shows the log and says what to do.

say() { printf '%s\n' "$*" >&2; }
die() {
  say "error: $*"
  exit 1
}

# The last lines of a log, where a failure shows.
show_log() {
  tail -n 60 "$1" >&2
  say "(the last lines of $1)"
}

# missing_packages LIST...: those packages of the lists that are not installed, one a line.
missing_packages() {
  local wanted
  # One question for all packages, so that an up-to-date machine loses no time. Unknown ones make its status 1.
  wanted=$(sed 's/#.*//' "$@")
  # shellcheck disable=SC2086  # a word is a package
  { dpkg-query -W -f '${Package} ${db:Status-Status}\n' $wanted 2>/dev/null || true; } |
    awk -v wanted="$wanted" '$2 == "installed" { have[$1] = 1 }
      END { n = split(wanted, names); for (i = 1; i <= n; ++i) if (!(names[i] in have)) print names[i] }'
}

# install_missing LIST...: installs them; does nothing where nothing is missing.
install_missing() {
  if ! command -v dpkg-query >/dev/null; then
    say "This is no Debian or Ubuntu: taking for granted that what tools/packages-*.txt list is there."
    return 0
  fi
  local missing
  missing=$(missing_packages "$@" | tr '\n' ' ')
  if [ -z "$missing" ]; then return 0; fi

  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || die "these packages are missing: $missing
Install them as root (apt-get install --no-install-recommends $missing), or install sudo, then start this again."
    as_root=(sudo)
  fi
  say "Installing the packages that are missing: $missing"
  local log
  log=$(mktemp)
  # An index that cannot be refreshed does not matter if the packages are found all the same.
  "${as_root[@]}" apt-get update -qq >"$log" 2>&1 </dev/null || true
  # shellcheck disable=SC2086  # a word is a package
  if ! "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 install -y -qq \
    --no-install-recommends $missing >>"$log" 2>&1 </dev/null; then
    show_log "$log"
    die "apt-get could not install: $missing"
  fi
  rm -f "$log"
}

# configure OPTION...: configures build/ with these CMake options, where that has not been done with the same ones.
configure() {
  local stamp="$root/build/.configured-with"
  set -- "-DORRERY_WERROR=${ORRERY_WERROR:-OFF}" "$@"
  if [ -f "$stamp" ] && [ "$(cat "$stamp")" = "$*" ]; then return 0; fi
  mkdir -p "$root/build"
  if ! cmake -S "$root" -B "$root/build" -G Ninja -DCMAKE_BUILD_TYPE=Release "$@" >"$root/build/configure.log" 2>&1; then
    show_log "$root/build/configure.log"
    die "CMake could not configure; where $root/build is left from something else, remove it and start this again"
  fi
  printf '%s' "$*" >"$stamp"
}

# build MINUTES TARGET: builds a target in build/. MINUTES is what that takes one core the first time, for the message.
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
    say "Building what has changed ..."
  fi
  # Two that start at once, of one checkout, take turns.
  exec 9>"$root/build/.lock"
  flock 9
  if ! cmake --build "$root/build" --target "$target" >"$root/build/build.log" 2>&1 9>&-; then
    show_log "$root/build/build.log"
    die "orrery could not be built; where memory was short, CMAKE_BUILD_PARALLEL_LEVEL=1 before the command helps"
  fi
  exec 9>&-
  touch "$stamp"
  # shellcheck disable=SC2034  # for the scripts that source this
  build_seconds=$((SECONDS - begin))
  if [ "$first" = 1 ]; then say "Built in $build_seconds s."; fi
}
