#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the README's two commands as a new user would: in a minimal Debian root, from a fresh clone of HEAD.
#
#   tools/minimal-root.sh bookworm|trixie [run]
#
# With `run` only ./run.sh is run, for a Debian release on which ./test.sh runs anyway.
#
# KEEP=1          keep the root and print its path
# ORRERY_DEBS=DIR package cache, kept between runs
# ORRERY_CCACHE=DIR  compiler cache to fill, for a later build with the same compiler outside the root
#
# Exit status: 0 success; 77 this machine cannot create the root (the reason is printed); otherwise a command failed.
set -euo pipefail
suite=${1:?bookworm or trixie}
commands=${2:-both}
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
begin=$SECONDS

say() { printf 'minimal root %s, %3d s: %s\n' "$suite" $((SECONDS - begin)) "$*" >&2; }
skip() {
  say "skipped: $*"
  exit 77
}
[ "$(id -u)" -eq 0 ] || skip "creating a root requires root privileges"
if ! command -v debootstrap >/dev/null; then
  { apt-get update -qq && apt-get install -y -qq --no-install-recommends debootstrap; } >/dev/null 2>&1 </dev/null ||
    skip "debootstrap cannot be installed"
fi

debs=${ORRERY_DEBS:-${TMPDIR:-/var/tmp}/orrery-debs}/$suite
mkdir -p "$debs/partial"
work=$(mktemp -d "${TMPDIR:-/var/tmp}/orrery-root.XXXXXX")
root="$work/root"
cleanup() {
  for mount in "$root/var/cache/apt/archives" "$root/var/cache/ccache" "$root/dev/shm" "$root/proc"; do
    if mountpoint -q "$mount"; then umount "$mount" || umount -l "$mount"; fi
  done
  if [ -n "${KEEP:-}" ]; then
    say "kept in $root"
  else
    rm -rf --one-file-system "$work"
  fi
}
trap cleanup EXIT
trap 'exit 130' INT TERM

# The mirror that this machine uses, otherwise Debian's.
mirror=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' 'Component: main' 2>/dev/null | grep -m1 '/debian/*$' || true)
mirror=${mirror:-http://deb.debian.org/debian}
say "creating the root from $mirror"
if ! debootstrap --variant=minbase --include=git,ca-certificates --cache-dir="$debs" "$suite" "$root" "$mirror" \
  >"$work/debootstrap.log" 2>&1 </dev/null; then
  tail -n 3 "$work/debootstrap.log" >&2
  skip "debootstrap failed"
fi
# Proxy and resolver settings of this machine, if it has any.
for file in /etc/apt/apt.conf.d/*proxy* /etc/resolv.conf; do
  if [ -f "$file" ]; then cp "$file" "$root$file"; fi
done
mount -t proc proc "$root/proc" 2>/dev/null || skip "proc cannot be mounted here"
mount --bind "$debs" "$root/var/cache/apt/archives"
# Test files go to /dev/shm, as on a running Debian; if this fails they go to the disk.
mkdir -p "$root/dev/shm"
mount -t tmpfs tmpfs "$root/dev/shm" 2>/dev/null || true

# git refuses to read a checkout of another owner without this.
HOME=$work git config --global --add safe.directory '*'
HOME=$work git clone -q --no-hardlinks "file://$repository" "$root/orrery"
environment=(HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 ORRERY_WERROR=ON)
in_root() {
  chroot "$root" env -i "${environment[@]}" /bin/sh -c "cd /orrery && $1" </dev/null
}

in_root 'apt-get update -qq' >"$work/update.log" 2>&1 || skip "the root cannot reach the mirror"
if [ -n "${ORRERY_CCACHE:-}" ]; then
  mkdir -p "$ORRERY_CCACHE" "$root/var/cache/ccache"
  mount --bind "$ORRERY_CCACHE" "$root/var/cache/ccache"
  in_root 'apt-get install -y -qq --no-install-recommends ccache' >"$work/ccache.log" 2>&1
  environment+=(CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_DIR=/var/cache/ccache CCACHE_BASEDIR=/orrery)
fi

say "./run.sh"
# The default scene at a size that renders in seconds. The second call must have nothing left to build.
in_root './run.sh render scenes/book/final.toml -o /tmp/final.exr -o /tmp/final.png -q \
  --set image.width=160 --set image.height=90 --set render.samples=16 && test -s /tmp/final.exr && test -s /tmp/final.png'
say "./run.sh --install"
# To ~/.local, with a hint at the PATH; found by the manual and by fish; and without a hint once it is on the PATH.
in_root './run.sh --install 2>&1 | tee /tmp/install.log && grep -qF "export PATH=\"/root/.local/bin:\$PATH\"" /tmp/install.log'
in_root 'export PATH=/root/.local/bin:$PATH && cd / && orrery --version && orrery render /orrery/scenes/book/final.toml \
  -o /tmp/installed.png -q --set image.width=160 --set image.height=90 --set render.samples=16 && test -s /tmp/installed.png &&
  cd /root/.local/share && test -s man/man1/orrery.1 && test -s bash-completion/completions/orrery &&
  test -s zsh/site-functions/_orrery && test -s fish/vendor_completions.d/orrery.fish && test ! -e /root/.local/include &&
  ! /orrery/run.sh --install 2>&1 | grep PATH'

if [ "$commands" = run ]; then
  say "done"
  exit 0
fi
say "./test.sh"
# Only tests that depend on versions of libraries and compilers; benchmarks and the long statistical ones do not.
in_root "ORRERY_BENCH=OFF ./test.sh -LE 'slow|statistical|numeric|fuzz'"
say "done"
