#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Uses the archive of tools/portable.sh.
#
#   portable.sh anywhere ARCHIVE PROGRAM WORK_FOLDER         as any user, in folders with difficult names and properties
#   portable.sh root ARCHIVE PROGRAM WORK_FOLDER [ROOT]      in a root that has only the archive and /proc, or in ROOT,
#                                                            that of another system
#
# PROGRAM is orrery of the same build, whose images must have the same bytes. Exit status: 77 if this machine cannot make
# the root; the reason is printed.
set -euo pipefail
[ -f "$2" ] || { echo "skipped: there is no archive"; exit 77; }
mode=$1 archive=$(realpath "$2") program=$(realpath "$3") work=$4 root=${5:-}
here=$(cd "$(dirname "$0")" && pwd)
small=(--set image.width=64 --set image.height=36 --samples 4 -q --reproducible)
fail() {
  echo "portable.sh: $*" >&2
  exit 1
}
# expect STATUS TEXT COMMAND...: the command ends with this status, and prints a text that contains TEXT.
expect() {
  local status=0 printed
  printed=$("${@:3}" 2>&1) || status=$?
  if [ "$status" != "$1" ] || [[ "$printed" != *"$2"* ]]; then fail "${*:3}: status $status, not $1; it must print '$2': $printed"; fi
}
# expect_render COMMAND...: `COMMAND render` gives the bytes of the build.
expect_render() {
  rm -f image.exr
  "$@" render "${scene:-scene.toml}" -o "${out:-.}/image.exr" "${small[@]}" || fail "$* does not render"
  cmp "$image" expected.exr || fail "$* renders other bytes than the build"
}

if [ "$mode" = root ] && [ -z "${ORRERY_IN_NAMESPACE:-}" ]; then
  as_root=(--map-root-user)
  if [ "$(id -u)" -eq 0 ]; then as_root=(); fi
  unshare "${as_root[@]}" --mount --pid --fork true 2>/dev/null || { echo "skipped: this system permits no namespaces"; exit 77; }
  ORRERY_IN_NAMESPACE=1 exec unshare "${as_root[@]}" --mount --pid --fork "$0" "$@"
fi

rm -rf "$work"
mkdir -p "$work"
cd "$work"
cp "$here/../../scenes/book/final.toml" scene.toml
"$program" render scene.toml -o expected.exr "${small[@]}"
plot=(plot "" -q --width 160 --height 90 --samples 4 --scale-bar '50 Å' --title 'Capsomer' --color-by chain)
protein=$here/../../examples/protein/capsomer.pdb.xz
plot[1]=$protein
"$program" "${plot[@]}" -o expected.png

if [ "$mode" = anywhere ]; then
  image=image.exr
  size=$(stat -c %s "$archive")
  [ "$size" -le 30000000 ] || fail "the archive has $size bytes"
  tar xf "$archive"
  name=$(basename "$archive" .tar.xz)
  size=$(du -sb "$name" | cut -f 1)
  [ "$size" -le 110000000 ] || fail "the archive has $size bytes unpacked"
  for file in LICENSE orrery.spdx.json licenses/libc6 licenses/fonts-dejavu-core licenses/common-licenses/GPL-3; do
    [ -s "$name/share/doc/orrery/$file" ] || fail "the archive has no $file"
  done
  for file in man/man1/orrery.1 bash-completion/completions/orrery zsh/site-functions/_orrery; do
    [ -s "$name/share/$file" ] || fail "the archive has no $file"
  done
  [ -s "$name/scenes/book/final.toml" ] || fail "the archive has no scenes"
  # Each library has its licence, and is in the SBOM.
  for file in "$name"/lib/*; do
    found=
    for package in $(dpkg-query -S "*/$(basename "$file")" 2>/dev/null | awk -F '[:,]' '!/^diversion/ { print $1 }'); do
      if [ -s "$name/share/doc/orrery/licenses/$package" ] &&
        grep -qF "pkg:deb/debian/${package//+/%2B}@" "$name/share/doc/orrery/orrery.spdx.json"; then found=1; fi
    done
    [ -n "$found" ] || fail "no licence of $file"
  done
  expect_render "$name/bin/orrery"
  "$name/bin/orrery" "${plot[@]}" -o image.png
  "$program" compare image.png expected.png --fail-above max=0 >compared || fail "another plot than that of the build"

  mv "$name" 'with spaces: colons; and é'
  expect_render 'with spaces: colons; and é/bin/orrery'
  ln -s "$PWD/with spaces: colons; and é/bin/orrery" link
  (
    cd /
    "$work/link" --version >/dev/null
  )
  expect_render ./link
  # Libraries of others, older or damaged ones, are not loaded.
  mkdir hostile
  for file in with*/lib/*; do echo damaged >"hostile/$(basename "$file")"; done
  expect_render env "LD_LIBRARY_PATH=$PWD/hostile" ./link
  # Another version beside it shares nothing with this one.
  tar xf "$archive"
  for copy in "$name" with*; do
    others=$(LD_TRACE_LOADED_OBJECTS=1 "$copy/bin/orrery" --version | grep -F ' => ' | grep -vF " => $(realpath "$copy")" || true)
    [ -z "$others" ] || fail "$copy loads $others"
  done
  chmod -R a-w "$name"
  expect_render "$name/bin/orrery"
  chmod -R u+w "$name"
  rm "$name/libexec/orrery/orrery-program"
  expect 127 'orrery-program: cannot open shared object file' "$name/bin/orrery" --version
  rm -r "$name/libexec"
  expect 70 'cannot start the program' "$name/bin/orrery" --version
  # An archive of which only a part could be unpacked has no command.
  rm -r "$name"
  xz -dc "$archive" | dd bs=1M count=60 status=none iflag=fullblock | tar x 2>/dev/null && fail "half an archive is no error"
  [ -d "$name/lib" ] && [ ! -e "$name/bin/orrery" ] || fail "half an archive has a command"
  # Linux 3.17 has no later system calls than memfd_create.
  expect_render python3 "$here/old_kernel.py" 319 ./link
  if command -v qemu-x86_64 >/dev/null; then expect 70 'lacks SSE4.2, AES and PCLMUL' qemu-x86_64 -cpu core2duo ./link --version; fi
  exit 0
fi

if [ -z "$root" ]; then
  root=$PWD/root
  mkdir root
fi
mkdir -p "$root/proc" "$root/opt" "$root/data"
mount -t proc proc "$root/proc" 2>/dev/null || { echo "skipped: /proc cannot be mounted here"; exit 77; }
tar xf "$archive" -C "$root/opt"
mv "$root/opt"/* "$root/opt/orrery"
cp scene.toml "$protein" "$root/data"
# orrery, with nothing of this system but the kernel and the network.
in_root=(env -i TMPDIR=/data "$(command -v chroot)" "$root" /opt/orrery/bin/orrery)
image=$root/data/image.exr scene=/data/scene.toml out=/data
plot[1]=/data/capsomer.pdb.xz

expect 0 'orrery ' "${in_root[@]}" --version
expect_render "${in_root[@]}"
"${in_root[@]}" "${plot[@]}" -o /data/image.png
"$program" compare "$root/data/image.png" expected.png --fail-above max=0 >compared || fail "another plot than that of the build"
expect 73 'the program ffmpeg was not found' "${in_root[@]}" plot /data/capsomer.pdb.xz -o /data/film.mp4 --turntable 1s
expect 0 '#SBATCH' "${in_root[@]}" submit /data/scene.toml -o /data/image.exr --shards 2 --slurm
# The view answers.
"${in_root[@]}" view /data/capsomer.pdb.xz >address &
view=$!
for _ in $(seq 600); do
  [ -s address ] && break
  sleep 0.1
done
port=$(sed -nE 's|.*http://127.0.0.1:([0-9]+)/.*|\1|p' address)
exec 3<>"/dev/tcp/127.0.0.1/$port"
printf 'GET / HTTP/1.1\r\nHost: 127.0.0.1:%s\r\nConnection: close\r\n\r\n' "$port" >&3
page=$(cat <&3)
exec 3>&-
kill -TERM "$view"
wait "$view" || fail "view ended with status $?"
[[ "$page" == 'HTTP/1.1 200'*'<html'* ]] || fail "view answered ${page:0:200}"
# What is missing is named.
mv "$root/opt/orrery/share/orrery/fonts" fonts
if [ ! -d "$root/usr/share/fonts" ]; then expect 66 'there is no font DejaVuSans' "${in_root[@]}" "${plot[@]}" -o /data/image.png; fi
mv fonts "$root/opt/orrery/share/orrery"
# Where programs must not be executed.
mount --bind "$root/opt" "$root/opt"
mount -o remount,bind,noexec "$root/opt"
expect 126 'Permission denied' "${in_root[@]}" --version
mount -o remount,bind,exec,ro "$root/opt"
expect_render "${in_root[@]}"
umount "$root/opt" "$root/proc"
