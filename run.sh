#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs missing packages, builds, and runs orrery with the given arguments, or installs it; see usage().
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$root/tools/setup.sh"

usage() {
  cat <<'END'
Usage: ./run.sh                      render the final scene of the book into out/
       ./run.sh ARGUMENT...          run orrery with these arguments, e.g. ./run.sh plot examples/protein/capsomer.pdb.xz -o capsomer.png
       ./run.sh --install [PREFIX]   install orrery below PREFIX (default: ~/.local), with manual page and completions

Each form first installs missing packages of the system and builds what has changed.
`./run.sh COMMAND --help` describes a command of orrery; `build/src/orrery --help` lists the commands.
END
}

# install_prefix ARGUMENT...: the absolute prefix of --install. Fails before the build if it cannot be written to.
install_prefix() {
  if [ $# -gt 1 ] || [[ "${1:-}" == -* ]]; then
    say "error: --install takes one folder, not '$*'"
    usage >&2
    exit 64
  fi
  local prefix reason
  prefix=$(realpath -ms -- "${1:-$HOME/.local}")
  if ! reason=$(mkdir -p -- "$prefix/bin" 2>&1) || ! [ -w "$prefix/bin" ]; then
    say "error: cannot install below $prefix: ${reason:-no permission to write to $prefix/bin}
Name another folder, or install as root: sudo ./run.sh --install ${1:-}"
    exit 73
  fi
  printf '%s' "$prefix"
}

# install_program PREFIX: installs the program and says how to call it.
install_program() {
  local prefix=$1 log=$root/build/install.log
  # Not the libraries and the Python package, which a build for tests also has.
  if ! cmake --install "$root/build" --prefix "$prefix" --component runtime >"$log" 2>&1; then
    show_log "$log"
    die "the installation failed"
  fi
  say "Installed $prefix/bin/orrery. To remove it: xargs -d '\n' rm < $root/build/install_manifest_runtime.txt"
  local found
  found=$(command -v orrery || true)
  if [ "$found" = "$prefix/bin/orrery" ]; then return 0; fi
  if [ -n "$found" ]; then say "The command orrery is still $found, which precedes it on the PATH."; fi
  case "${SHELL:-}" in
    */fish) say "To call it as orrery, run once: fish_add_path --prepend $prefix/bin" ;;
    */zsh) say "To call it as orrery, add these lines to the start of ~/.zshrc:
  export PATH=\"$prefix/bin:\$PATH\"
  fpath=(\"$prefix/share/zsh/site-functions\" \$fpath)" ;;
    *) say "To call it as orrery, add this line to ~/.bashrc:
  export PATH=\"$prefix/bin:\$PATH\"" ;;
  esac
}

prefix=
case "${1:-}" in
  -h | --help)
    usage
    exit 0
    ;;
  --install) prefix=$(install_prefix "${@:2}") ;;
esac

install_missing "$root/tools/packages-build.txt"
# An existing configuration, for example that of test.sh, is kept. For this machine alone, one instruction set is compiled
# instead of three; what is installed may be copied to others.
minutes=6
if [ -n "$prefix" ]; then
  minutes=9
  if ! grep -qs -- -DORRERY_ISAS=all "$root/build/.configured-with"; then
    configure -DBUILD_TESTING=OFF -DORRERY_ISAS=all
  fi
elif [ ! -f "$root/build/.configured-with" ]; then
  configure -DBUILD_TESTING=OFF -DORRERY_ISAS=native
fi
build "$minutes" orrery

if [ -n "$prefix" ]; then
  install_program "$prefix"
  exit 0
fi

orrery="$root/build/src/orrery"
if [ $# -gt 0 ]; then exec "$orrery" "$@"; fi

mkdir -p "$root/out"
say "Rendering scenes/book/final.toml ..."
"$orrery" render "$root/scenes/book/final.toml" -o "$root/out/final.exr" -o "$root/out/final.png"
say "Image for display:            $root/out/final.png"
say "Scene-linear EXR:             $root/out/final.exr"
