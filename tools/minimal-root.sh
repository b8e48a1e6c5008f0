#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Follows the instructions for new users: in a minimal Debian root, from a fresh clone of HEAD, ./run.sh and ./test.sh;
# then the Debian packages, which are installed, used and removed in a second root that has nothing else, and, where
# Debian has scikit-build-core, `pip install .`.
#
#   tools/minimal-root.sh bookworm|trixie [run|packages]
#   tools/minimal-root.sh SUITE archive FILE     the archive of tools/portable.sh in another root, e.g. bullseye
#
# With `run` only ./run.sh is run, for a Debian release on which ./test.sh runs anyway; `packages` leaves out ./test.sh.
#
# KEEP=1             keep the root and print its path
# ORRERY_UNITY=OFF   compile each file by itself, which must include what it uses
# ORRERY_DEBS=DIR    package cache, kept between runs
# ORRERY_CCACHE=DIR  compiler cache to fill, for a later build with the same compiler outside the root
#
# Exit status: 0 success; 77 this machine cannot create the root (the reason is printed); otherwise a command failed.
set -euo pipefail
suite=${1:?bookworm or trixie}
commands=${2:-all}
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
# In memory, if two roots and what they build fit: packages are unpacked without waiting for a disk.
if [ -z "${TMPDIR:-}" ] && [ "$(stat -f -c %T /dev/shm 2>/dev/null)" = tmpfs ] &&
  [ "$(df --output=avail -B 1M /dev/shm | tail -n 1)" -ge 8192 ] &&
  [ "$(awk '/^MemAvailable:/ { print int($2 / 1024) }' /proc/meminfo)" -ge 16384 ]; then
  TMPDIR=/dev/shm
fi
work=$(mktemp -d "${TMPDIR:-/var/tmp}/orrery-root.XXXXXX")
root="$work/root"
bare="$work/bare"
cleanup() {
  for folder in "$root" "$bare"; do
    for mount in "$folder/var/cache/apt/archives" "$folder/var/cache/ccache" "$folder/dev/shm" "$folder/proc"; do
      if mountpoint -q "$mount"; then umount "$mount" || umount -l "$mount"; fi
    done
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
include=git,ca-certificates
if [ "$commands" = archive ]; then include=libc-bin; fi
if ! debootstrap --variant=minbase "--include=$include" --cache-dir="$debs" "$suite" "$root" "$mirror" \
  >"$work/debootstrap.log" 2>&1 </dev/null; then
  tail -n 3 "$work/debootstrap.log" >&2
  skip "debootstrap failed"
fi
if [ "$commands" = archive ]; then
  say "the archive"
  "$repository/tests/consumer/portable.sh" root "$3" "${ORRERY:-$repository/build/src/orrery}" "$work/portable" "$root"
  say "done"
  exit 0
fi
# Proxy and resolver settings of this machine, if it has any.
for file in /etc/apt/apt.conf.d/*proxy* /etc/resolv.conf; do
  if [ -f "$file" ]; then cp "$file" "$root$file"; fi
done
if [ "$commands" != run ]; then cp -a "$root" "$bare"; fi
# prepare FOLDER: mounts what a root needs.
prepare() {
  mount -t proc proc "$1/proc" 2>/dev/null || skip "proc cannot be mounted here"
  mount --bind "$debs" "$1/var/cache/apt/archives"
  # Test files go to /dev/shm, as on a running Debian; if this fails they go to the disk.
  mkdir -p "$1/dev/shm"
  mount -t tmpfs tmpfs "$1/dev/shm" 2>/dev/null || true
}
prepare "$root"

# git refuses to read a checkout of another owner without this.
HOME=$work git config --global --add safe.directory '*'
HOME=$work git clone -q --no-hardlinks "file://$repository" "$root/orrery"
environment=(HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 ORRERY_WERROR=ON
  "ORRERY_UNITY=${ORRERY_UNITY:-ON}")
launcher=()  # only this root has ccache
in_root() {
  chroot "$root" env -i "${environment[@]}" "${launcher[@]}" /bin/sh -c "cd /orrery && $1" </dev/null
}

in_root 'apt-get update -qq' >"$work/update.log" 2>&1 || skip "the root cannot reach the mirror"
if [ -n "${ORRERY_CCACHE:-}" ]; then
  mkdir -p "$ORRERY_CCACHE" "$root/var/cache/ccache"
  mount --bind "$ORRERY_CCACHE" "$root/var/cache/ccache"
  in_root 'apt-get install -y -qq --no-install-recommends ccache' >"$work/ccache.log" 2>&1
  launcher=(CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_DIR=/var/cache/ccache CCACHE_BASEDIR=/orrery)
fi

say "./run.sh"
# The default scene at a size that renders in seconds. The second call must have nothing left to build.
in_root './run.sh render scenes/book/final.toml -o /tmp/final.exr -o /tmp/final.png -q \
  --set image.width=160 --set image.height=90 --set render.samples=16 && test -s /tmp/final.exr && test -s /tmp/final.png'
say "./run.sh --install"
# To ~/.local, with a hint at the PATH; found by the manual and by fish; and without a hint once it is on the PATH.
in_root './run.sh --install 2>&1 | tee /tmp/install.log && grep -qF "export PATH=\"$HOME/.local/bin:\$PATH\"" /tmp/install.log'
in_root 'export PATH=$HOME/.local/bin:$PATH && cd / && orrery --version && orrery render /orrery/scenes/book/final.toml \
  -o /tmp/installed.png -q --set image.width=160 --set image.height=90 --set render.samples=16 && test -s /tmp/installed.png &&
  cd $HOME/.local/share && test -s man/man1/orrery.1 && test -s bash-completion/completions/orrery &&
  test -s zsh/site-functions/_orrery && test -s fish/vendor_completions.d/orrery.fish && test ! -e $HOME/.local/include &&
  /orrery/run.sh --install >/tmp/install.log 2>&1 && ! grep PATH /tmp/install.log'

if [ "$commands" = run ]; then
  say "done"
  exit 0
fi
if [ "$commands" = all ]; then
  say "./test.sh"
  # Only tests that depend on versions of libraries and compilers; benchmarks and the long statistical ones do not.
  in_root "ORRERY_BENCH=OFF ./test.sh -LE 'slow|statistical|numeric|fuzz'"
fi

say "tools/packages.sh"
in_root tools/packages.sh
say "lintian"
in_root 'apt-get install -y -qq --no-install-recommends lintian >/tmp/lintian.log 2>&1 &&
  lintian --fail-on error --tag-display-limit 0 build/packages/*.deb'
say "packages in a bare root"
prepare "$bare"
mkdir "$bare/orrery"
cp -r "$root/orrery/build/packages" "$root/orrery/tests/consumer" "$root/orrery/scenes" "$root/orrery/examples" "$bare/orrery"
chroot "$bare" env -i "${environment[@]}" /orrery/consumer/packages.sh /orrery/packages </dev/null

if in_root 'apt-cache show python3-scikit-build-core' >/dev/null 2>&1; then
  say "pip install ."
  in_root tests/consumer/pip.sh
fi
say "done"
