#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Tries the two commands of the README as a stranger would: in a minimal Debian root, from a fresh clone.
#
#   tools/minimal-root.sh bookworm|trixie
#
# Exit status: 0 both work, 77 this machine cannot make the root (and why), anything else: they do not work.
set -euo pipefail
suite=${1:?bookworm or trixie}
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

skip() {
  printf 'minimal root %s left out: %s\n' "$suite" "$*" >&2
  exit 77
}
[ "$(id -u)" -eq 0 ] || skip "only root can make one"
if ! command -v debootstrap >/dev/null; then
  { apt-get update -qq && apt-get install -y -qq --no-install-recommends debootstrap; } >/dev/null 2>&1 </dev/null ||
    skip "debootstrap cannot be installed"
fi

work=$(mktemp -d "${TMPDIR:-/var/tmp}/orrery-root.XXXXXX")
root="$work/root"
cleanup() {
  for mount in "$root/var/cache/apt/archives" "$root/proc"; do
    if mountpoint -q "$mount"; then umount "$mount" || umount -l "$mount"; fi
  done
  rm -rf --one-file-system "$work"
}
trap cleanup EXIT
trap 'exit 130' INT TERM

# The mirror that this machine itself installs from; Debian's own where it has none of its own.
mirror=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' 'Component: main' 2>/dev/null | grep -m1 '/debian$' || true)
mirror=${mirror:-http://deb.debian.org/debian}
printf 'minimal root %s: making it\n' "$suite" >&2
debootstrap --variant=minbase --include=git,ca-certificates "$suite" "$root" "$mirror" >"$work/debootstrap.log" 2>&1 </dev/null || {
  tail -n 3 "$work/debootstrap.log" >&2
  skip "debootstrap failed"
}
# The host's way to the mirror, where it needs one.
for file in /etc/apt/apt.conf.d/*proxy* /etc/resolv.conf; do
  if [ -f "$file" ]; then cp "$file" "$root$file"; fi
done
mount -t proc proc "$root/proc" || skip "proc cannot be mounted"

git clone -q --no-hardlinks "$repository" "$root/orrery"
in_root() { chroot "$root" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 "$@" </dev/null; }

printf 'minimal root %s: ./run.sh\n' "$suite" >&2
# The default picture at a size that is ready in seconds, then the program through the same script.
in_root /bin/sh -c 'cd /orrery && ./run.sh render scenes/book/final.toml -o /tmp/final.exr -o /tmp/final.png -q --width 240 --height 135 --samples 20 && test -s /tmp/final.exr && test -s /tmp/final.png'
in_root /bin/sh -c 'cd /orrery && ./run.sh --version'

printf 'minimal root %s: ./test.sh\n' "$suite" >&2
# What depends on the libraries' versions; the long statistics do not.
in_root /bin/sh -c "cd /orrery && ORRERY_WERROR=ON ./test.sh -LE 'slow|statistical|numeric|fuzz|consumer'"
