#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Tries the two commands of the README as a stranger would: in a minimal Debian root, from a fresh clone of HEAD.
#
#   tools/minimal-root.sh bookworm|trixie [run]
#
# With `run` only ./run.sh is tried, where ./test.sh has been on the same Debian already.
#
# KEEP=1          leave the root behind and say where
# ORRERY_DEBS=DIR where packages are kept from one run to the next
#
# Exit status: 0 both work, 77 this machine cannot make the root (and why), anything else: they do not work.
set -euo pipefail
suite=${1:?bookworm or trixie}
commands=${2:-both}
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
begin=$SECONDS

say() { printf 'minimal root %s, %3d s: %s\n' "$suite" $((SECONDS - begin)) "$*" >&2; }
skip() {
  say "left out: $*"
  exit 77
}
[ "$(id -u)" -eq 0 ] || skip "only root can make one"
if ! command -v debootstrap >/dev/null; then
  { apt-get update -qq && apt-get install -y -qq --no-install-recommends debootstrap; } >/dev/null 2>&1 </dev/null ||
    skip "debootstrap cannot be installed"
fi

debs=${ORRERY_DEBS:-${TMPDIR:-/var/tmp}/orrery-debs}/$suite
mkdir -p "$debs/partial"
work=$(mktemp -d "${TMPDIR:-/var/tmp}/orrery-root.XXXXXX")
root="$work/root"
cleanup() {
  for mount in "$root/var/cache/apt/archives" "$root/dev/shm" "$root/proc"; do
    if mountpoint -q "$mount"; then umount "$mount" || umount -l "$mount"; fi
  done
  if [ -n "${KEEP:-}" ]; then
    say "left in $root"
  else
    rm -rf --one-file-system "$work"
  fi
}
trap cleanup EXIT
trap 'exit 130' INT TERM

# The mirror that this machine itself installs from; Debian's own where it has none.
mirror=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' 'Component: main' 2>/dev/null | grep -m1 '/debian/*$' || true)
mirror=${mirror:-http://deb.debian.org/debian}
say "making it from $mirror"
if ! debootstrap --variant=minbase --include=git,ca-certificates --cache-dir="$debs" "$suite" "$root" "$mirror" \
  >"$work/debootstrap.log" 2>&1 </dev/null; then
  tail -n 3 "$work/debootstrap.log" >&2
  skip "debootstrap failed"
fi
# This machine's way to the mirror, where it needs one.
for file in /etc/apt/apt.conf.d/*proxy* /etc/resolv.conf; do
  if [ -f "$file" ]; then cp "$file" "$root$file"; fi
done
mount -t proc proc "$root/proc" 2>/dev/null || skip "proc cannot be mounted here"
mount --bind "$debs" "$root/var/cache/apt/archives"
# For the files of tests, as on any running Debian; without it they go to the disk.
mkdir -p "$root/dev/shm"
mount -t tmpfs tmpfs "$root/dev/shm" 2>/dev/null || true

# A checkout may belong to somebody else than root; this one is to be read all the same.
HOME=$work git config --global --add safe.directory '*'
HOME=$work git clone -q --no-hardlinks "file://$repository" "$root/orrery"
in_root() {
  chroot "$root" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 ORRERY_WERROR=ON \
    /bin/sh -c "cd /orrery && $1" </dev/null
}

in_root 'apt-get update -qq' >"$work/update.log" 2>&1 || skip "the root cannot reach the mirror"

say "./run.sh"
# The default picture at a size that is ready in seconds; the second call must find nothing left to do.
in_root './run.sh render scenes/book/final.toml -o /tmp/final.exr -o /tmp/final.png -q \
  --set image.width=160 --set image.height=90 --set render.samples=16 && test -s /tmp/final.exr && test -s /tmp/final.png'
say "./run.sh --version"
in_root './run.sh --version'

if [ "$commands" = run ]; then
  say "done"
  exit 0
fi
say "./test.sh"
# What depends on the versions of libraries and compilers; the long statistics do not.
in_root "./test.sh -LE 'slow|statistical|numeric|fuzz'"
say "done"
