#!/bin/sh
# ./dev fuzz: libFuzzer's search over all fuzz targets, or the named ones, two at a time. What it learns
# about a target stays in build/fuzz/corpus; what it finds stays in out/fuzz and ends the run badly.
set -eu

seconds=60
targets=
while [ $# -gt 0 ]; do
  case $1 in
    --seconds) seconds=${2:-}; shift 2 ||
      { echo 'fuzz: --seconds needs a value' >&2; exit 1; } ;;
    -*) echo "fuzz: unknown option '$1'; ./dev fuzz --help" >&2; exit 1 ;;
    *) targets="$targets $1"; shift ;;
  esac
done
case $seconds in ''|*[!0-9]*|0*) echo "fuzz: --seconds $seconds: a whole number above 0" >&2; exit 1 ;; esac

cd -- "$(dirname -- "$0")/../.."
known=$(ls tests/fuzz/corpus)
for target in $targets; do
  [ -d "tests/fuzz/corpus/$target" ] ||
    { echo "fuzz: no target '$target'; there is:" $known >&2; exit 1; }
done

# One target; its whole log is build/fuzz/NAME.log.
one='
  target=$1 seconds=$2
  found=out/fuzz/$target
  mkdir -p "build/fuzz/corpus/$target" "$found"
  export ASAN_OPTIONS=detect_stack_use_after_return=1:strict_string_checks=1:detect_leaks=1
  export UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1
  rc=0
  nice "build/fuzz/bin/${target}_fuzz" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 \
    -max_len=8192 -artifact_prefix="$found/" \
    "build/fuzz/corpus/$target" "tests/fuzz/corpus/$target" \
    > "build/fuzz/$target.log" 2>&1 </dev/null || rc=$?
  runs=$(sed -n "s/^Done \([0-9]*\) runs.*/\1/p" "build/fuzz/$target.log")
  if [ "$rc" = 0 ]; then
    printf "fuzz: %-18s %10s inputs, nothing found\n" "$target" "$runs"
  else
    printf "fuzz: %s: FOUND (exit status %s)\n" "$target" "$rc" >&2
    grep -aE "^(broken promise|SUMMARY|==[0-9]+==ERROR|Test unit written)|runtime error" \
      "build/fuzz/$target.log" | head -n 6 | sed "s/^/    /" >&2
    printf "    whole log: build/fuzz/%s.log; repair it, then keep the input in" "$target" >&2
    printf " tests/fuzz/corpus/%s under a name that says what it is\n" "$target" >&2
    exit 1
  fi'
printf '%s\n' ${targets:-$known} | xargs -I{} -P 2 sh -c "$one" fuzz {} "$seconds"
