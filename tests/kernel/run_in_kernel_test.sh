#!/bin/sh
# What run_in_kernel.sh promises: streams, statuses, files, time and clear refusals.
# usage: run_in_kernel_test.sh INIT
set -eu

here=$(cd -- "$(dirname -- "$0")" && pwd)
init=$1
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
failed=0

run() {  # OPTION... -- COMMAND...: leaves status, out and err
  status=0
  sh "$here/run_in_kernel.sh" --init "$init" --timeout 30 "$@" \
    > "$scratch/out" 2> "$scratch/err" || status=$?
  out=$(cat "$scratch/out")
  err=$(cat "$scratch/err")
}

expect() {  # SENTENCE WHAT-IS WHAT-SHOULD-BE
  if [ "$2" = "$3" ]; then
    printf 'ok: %s\n' "$1"
  else
    printf 'FAILED: %s: "%s" in place of "%s"\n' "$1" "$2" "$3"
    failed=1
  fi
}

sh "$here/run_in_kernel.sh" --find > /dev/null || { sh "$here/run_in_kernel.sh" --find; exit 77; }

run -- sh -c 'echo said; echo complained >&2; exit 7'
expect 'the exit status is the command'"'"'s' "$status" 7
expect 'stdout comes through alone' "$out" said
expect 'stderr comes through alone' "$err" complained

# shellcheck disable=SC2016  # expanded in the bed
run -- sh -c 'kill -ABRT $$'
expect 'a command that a signal ends is reported as a shell does' "$status" 134

run -- no-such-program
expect 'a missing command is reported as a shell does' "$status" 127

mkdir "$scratch/kept" "$scratch/lost"
run --write "$scratch/kept" -- touch "$scratch/kept/file" "$scratch/lost/file"
expect 'a file under --write is kept, another is not' \
  "$status $(find "$scratch/kept" "$scratch/lost" -name file | wc -l)" '0 1'

run --timeout 2 -- sleep 100
expect 'a command without an end is ended' "$status" 124

run -- printf '%s|' 'two words' '' '*' 'quote"s'
expect 'arguments arrive as they are' "$out" 'two words||*|quote"s|'

if sh "$here/run_in_kernel.sh" --find --virtual-time > /dev/null; then
  before=$(date +%s)
  run --virtual-time -- sleep 5000
  expect 'virtual time does not pass outside' "$status $(($(date +%s) - before < 60))" '0 1'
fi

status=0
out=$(KAGAMI_KERNEL_DIR=/nowhere sh "$here/run_in_kernel.sh" --init "$init" -- true) || status=$?
expect 'without a kernel it is skipped with the reason' "$status $out" \
  "77 SKIPPED: no test kernel in /nowhere - './dev kernel' builds it"

# Side by side, each has devices of its own.
for bed in 1 2 3; do
  (run -- mkdir /sys/kernel/config/gpio-sim/same; expect "bed $bed is alone" "$status" 0
   exit "$failed") > "$scratch/bed$bed" 2>&1 &
done
wait
cat "$scratch"/bed?
! grep -q FAILED "$scratch"/bed? || failed=1
exit "$failed"
