#!/bin/sh
# Builds the test kernel from Debian's own kernel source: User Mode Linux, a kernel that is a
# program, with the devices of bed.config and the repairs of patches/. Needs no root. The source
# comes from this machine's own Debian mirror and is checked by apt; apt's state is a private one,
# so nothing of the machine changes. What is built is kept in the cache, where run_in_kernel.sh
# looks for it.
#
# usage: build_kernel.sh [6.12|7.2]...       both, 7.2 only where the mirror has it
#   6.12 is in Debian 13 (trixie) and has virtual time; 7.2 is in forky and can unplug the screen.
# Needs: gcc make flex bison bc patch xz-utils, 2 GB for a while, 3 to 5 minutes per kernel on two cores.
set -eu
unset CDPATH

here=$(cd -- "$(dirname -- "$0")" && pwd)
cache=${XDG_CACHE_HOME:-${HOME:-/root}/.cache}/kagami/kernel-bed
needed_kib=2097152
objects=790  # about as many as a kernel has, for the progress

say() { printf 'kernel %s: %s\n' "$version" "$*"; }
die() { printf 'kernel %s: %s\n' "${version:-}" "$*" >&2; exit 1; }

suite_of() {
  case $1 in
    6.12) echo trixie ;;
    7.2) echo forky ;;
    *) die "no recipe for it: 6.12 or 7.2" ;;
  esac
}

# The machine's own Debian source with another suite: mirrors, keys and options stay as its owner
# set them.
machine_source() {  # SUITE OUTPUT-WITHOUT-SUFFIX
  codename=$( (. /etc/os-release && printf '%s' "${VERSION_CODENAME:-stable}") 2>/dev/null) ||
    codename=stable
  for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.list; do
    [ -f "$file" ] || continue
    line=$(sed -n -E "s/^(deb[[:space:]]+(\[[^]]*\][[:space:]]+)?[^[:space:]]+[[:space:]]+)($codename|stable)[[:space:]].*/\1$1 main/p" \
      "$file" | head -n 1)
    [ -z "$line" ] || { printf '%s\n' "$line" > "$2.list"; source=$2.list; return 0; }
  done
  for file in /etc/apt/sources.list.d/*.sources; do
    [ -f "$file" ] || continue
    awk -v suite="$1" -v codename="$codename" 'BEGIN { RS = ""; FS = "\n" }
      /(^|\n)Types:[^\n]*deb([^-]|$)/ && !/(^|\n)Enabled:[ \t]*no/ {
        if ($0 !~ "(^|\n)Suites:([^\n]*[ \t])?(" codename "|stable)([ \t\n]|$)") next
        for (i = 1; i <= NF; ++i) {
          if ($i ~ /^#/) continue
          if ($i ~ /^Types:/) $i = "Types: deb"
          if ($i ~ /^Suites:/) $i = "Suites: " suite
          if ($i ~ /^Components:/) $i = "Components: main"
          print $i
        }
        exit
      }' "$file" > "$2.sources"
    [ ! -s "$2.sources" ] || { source=$2.sources; return 0; }
  done
  die "no apt source of this machine names the suite $codename, so the one of $1 cannot be" \
    "derived: add Debian's to /etc/apt"
}

# apt with a state of its own, as any user.
private_apt() {
  apt-get -q -o Dir::Etc::sourcelist="$source" -o Dir::Etc::sourceparts=- \
    -o Dir::State::lists="$work/apt/lists" -o Dir::State::status="$work/apt/status" \
    -o Dir::Cache="$work/apt/cache" -o APT::Sandbox::User="$(id -un)" \
    -o APT::Architecture=amd64 -o Acquire::Languages=none -o APT::Update::Error-Mode=any "$@" \
    > "$work/apt.log" 2>&1
}

# 1 when the mirror does not have it.
fetch() {
  mkdir -p "$work/apt/lists/partial" "$work/apt/cache/archives/partial"
  : > "$work/apt/status"
  machine_source "$suite" "$work/apt/source"
  say "fetching linux-source-$version from this machine's Debian mirror ($suite)"
  private_apt update || return 1
  (cd "$work" && private_apt download "linux-source-$version") || return 1
}

unpack() {
  say 'unpacking'
  # Every file costs time twice, so the sources of what bed.config leaves out stay packed; their
  # Kconfig and Makefile are read all the same.
  set --
  for folder in sound drivers/media drivers/net/ethernet drivers/net/wireless drivers/infiniband \
      drivers/scsi drivers/staging drivers/gpu/drm/amd drivers/gpu/drm/i915 \
      drivers/gpu/drm/nouveau drivers/gpu/drm/radeon drivers/gpu/drm/msm; do
    set -- "$@" --exclude="*/$folder/*.[ch]"
  done
  dpkg-deb --fsys-tarfile "$work"/linux-source-*.deb |
    tar -xO "./usr/src/linux-source-$version.tar.xz" |
    tar -xJ -C "$work" --exclude='*/Documentation/*/*' --exclude='*/tools/testing/*' \
      --exclude='*.dts' --exclude='*.dtsi' "$@" || die 'unpacking failed (above): is the disk full?'
  tree=$work/linux-source-$version
  for patch in "$here"/patches/*.patch; do
    case $(basename "$patch") in
      "$version"-*) ;;
      [0-9]*) continue ;;  # of another version
    esac
    patch -s -p1 -d "$tree" < "$patch" ||
      die "$(basename "$patch") does not fit this source (above)"
  done
}

compile() {
  make_kernel() { make -C "$tree" ARCH=um O="$work/build" "$@"; }
  KCONFIG_ALLCONFIG="$here/bed.config" make_kernel -s allnoconfig > "$work/build.log" 2>&1 || {
    tail -n 15 "$work/build.log" >&2
    die 'configuring failed (above)'
  }
  # An option whose needs are not met is left out without a word.
  lost=$(grep -E '^CONFIG_[A-Z0-9_]+=' "$here/bed.config" | grep -vxFf "$work/build/.config") || true
  [ -z "$lost" ] || die "this source does not take:" $lost
  say "compiling about $objects files on $(nproc) CPUs"
  { rc=0
    make_kernel -j "$(nproc)" linux 2>&1 || rc=$?
    echo "exit $rc"
  } | tee "$work/build.log" | awk -v version="$version" -v objects="$objects" '
    BEGIN { step = objects / 10 }
    /^ +(CC|AS) / { if (++done % step == 0) {
      printf "kernel %s: %d files compiled\n", version, done; fflush() } }'
  [ "$(tail -n 1 "$work/build.log")" = 'exit 0' ] || {
    grep -E -m 5 -A 5 'error|Error|not found' "$work/build.log" >&2 ||
      tail -n 20 "$work/build.log" >&2
    die "compiling failed (above); the whole log is $work/build.log"
  }
  strip -o "$work/kernel" "$work/build/linux"
  # The kernel's own answer is the proof that it runs here.
  "$work/kernel" --version > /dev/null || die 'what was built does not start'
  mv "$work/kernel" "$cache/linux-uml-$version"
}

build() {
  suite=$(suite_of "$version")
  [ ! -x "$cache/linux-uml-$version" ] || { say "is in $cache"; return 0; }
  for tool in gcc make flex bison bc patch xz apt-get dpkg-deb; do
    command -v "$tool" >/dev/null || die "the program '$tool' is missing: ./dev kernel installs it"
  done
  [ "$(df -k --output=avail "$cache" | tail -n 1)" -ge "$needed_kib" ] ||
    die "$cache has less than $((needed_kib / 1024)) MiB free"
  work=$cache/build-$version
  rm -rf "$work"
  mkdir "$work"
  if ! fetch; then
    tail -n 3 "$work/apt.log" >&2
    [ -n "$optional" ] || die "the mirror does not give linux-source-$version (above)"
    say "left out: the mirror does not give it; tests that unplug the screen are skipped"
    rm -rf "$work"
    return 0
  fi
  unpack
  compile
  rm -rf "$work"
  say "built: $cache/linux-uml-$version"
}

[ "$(uname -m)" = x86_64 ] || die "the test kernel runs on x86-64 only, this is $(uname -m)"
mkdir -p "$cache" || die "no folder $cache"
exec 9> "$cache/lock"
flock -w 3600 9 || die "another process has been building in $cache for an hour"
all=
[ $# -gt 0 ] || { set -- 6.12 7.2; all=yes; }
for version in "$@"; do
  optional=
  [ -z "$all" ] || [ "$version" = 6.12 ] || optional=yes
  build
done
