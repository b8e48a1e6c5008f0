# SPDX-License-Identifier: Apache-2.0
# Sourced by run.sh and test.sh: installs what is missing, configures, builds. Quiet about what succeeds.

say() { printf '%s\n' "$*" >&2; }
die() { say "error: $*"; exit 1; }

# Installs the packages listed in the given files; does nothing where nothing is missing.
install_missing() {
  command -v dpkg-query >/dev/null || die "this script installs Debian packages; elsewhere install what tools/packages-*.txt lists, then use CMake"
  local wanted missing=()
  # The status of every wanted package in one question, so that an up-to-date machine loses no time.
  wanted=$(cat "$@")
  local have
  have=$(dpkg-query -W -f '${Package} ${db:Status-Status}\n' $wanted 2>/dev/null | awk '$2 == "installed" {print $1}')
  for package in $wanted; do
    grep -qx -- "$package" <<<"$have" || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || die "missing packages: ${missing[*]}; run this as root, or install sudo"
    as_root=(sudo)
  fi
  say "Installing ${#missing[@]} packages: ${missing[*]}"
  local log
  log=$(mktemp)
  if ! { "${as_root[@]}" apt-get update -qq &&
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"; } >"$log" 2>&1 </dev/null; then
    cat "$log" >&2
    die "apt-get could not install the packages above"
  fi
  rm -f "$log"
}

# Configures build/ with the given CMake options, where that has not been done with the same ones.
configure() {
  local stamp="$root/build/.configured-with" options="$*"
  [ -f "$stamp" ] && [ "$(cat "$stamp")" = "$options" ] && return
  mkdir -p "$root/build"
  if ! cmake -S "$root" -B "$root/build" -G Ninja -DCMAKE_BUILD_TYPE=Release "$@" >"$root/build/configure.log" 2>&1; then
    cat "$root/build/configure.log" >&2
    die "CMake could not configure; the log is above and in build/configure.log"
  fi
  printf '%s' "$options" >"$stamp"
}

# Builds the given targets.
build() {
  if [ ! -f "$root/build/.built-once" ]; then say "Building orrery; the first time takes some minutes"; fi
  if ! cmake --build "$root/build" --target "$@" >"$root/build/build.log" 2>&1; then
    cat "$root/build/build.log" >&2
    die "the build failed; the log is above and in build/build.log"
  fi
  touch "$root/build/.built-once"
}
