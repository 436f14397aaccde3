#!/bin/sh
# Boots the test kernel (User Mode Linux: a kernel that is a program) with this machine's files as
# its root, runs one command in it and gives back its output and exit status. In there
# /dev/dri/card0 is VKMS and gpio-sim makes GPIO chips, whatever this machine has. The command may
# write anywhere: what it writes is gone with the kernel, except under the folders of --write.
#
# usage: run_in_kernel.sh --init FILE [OPTION...] -- COMMAND [ARGUMENT...]
#        run_in_kernel.sh --find [--virtual-time]     prints the kernel's path
#   --init FILE          the bed's first process (built as kernel_bed_init)
#   --virtual-time       time jumps from timer to timer: CPU work costs none. Needs kernel 6.12
#   --write FOLDER       stays writable on this machine; may be given more than once
#   --memory SIZE        of the kernel, taken as it is used (default 2G)
#   --timeout SECONDS    then the kernel is ended: exit status 124
#   --log FILE           the kernel's own messages; shown when it died without a status
#   --kernel-arguments 'ARGUMENTS'
#
# Kernels, named linux-uml-6.12 and linux-uml-7.2, are looked for in $KAGAMI_KERNEL_DIR, or where
# that is not set in ../shared/kernel-bed beside the repository and then in the cache, which
# build_kernel.sh fills. Exit status 77 means skipped, with one line that says why.
set -eu
unset CDPATH

die() { printf 'run_in_kernel: %s\n' "$*" >&2; exit 2; }
skip() { printf 'SKIPPED: %s\n' "$*"; exit 77; }
folder_of() { (cd -- "$1" 2>/dev/null && pwd) || die "no folder '$1'"; }

here=$(folder_of "$(dirname -- "$0")")
init='' find='' virtual='' writable='' memory=2G limit='' log='' arguments=''
while [ $# -gt 0 ]; do
  case $1 in
    --find) find=yes ;;
    --virtual-time) virtual=yes ;;
    --init|--write|--memory|--timeout|--log|--kernel-arguments)
      [ $# -ge 2 ] || die "$1 needs a value"
      case $1 in
        --init) init=$2 ;;
        --write) writable=${writable:+$writable:}$(folder_of "$2") ;;
        --memory) memory=$2 ;;
        --timeout) limit=$2 ;;
        --log) log=$2 ;;
        --kernel-arguments) arguments=$2 ;;
      esac
      shift ;;
    --) shift; break ;;
    *) die "unknown option '$1'" ;;
  esac
  shift
done

# ---- which kernel --------------------------------------------------------------------------
# Only 6.12 has virtual time; 7.2 enters its processes by seccomp, which is faster than ptrace, and
# can unplug the screen.
versions=${virtual:+6.12}
versions=${versions:-7.2 6.12}
if [ -n "${KAGAMI_KERNEL_DIR:-}" ]; then
  set_folders() { printf '%s\n' "$KAGAMI_KERNEL_DIR"; }
else
  set_folders() {
    printf '%s\n' "$here/../../../shared/kernel-bed" \
      "${XDG_CACHE_HOME:-${HOME:-/root}/.cache}/kagami/kernel-bed"
  }
fi
[ "$(uname -m)" = x86_64 ] || skip "the test kernel runs on x86-64 only, this is $(uname -m)"
kernel=
for version in $versions; do
  while read -r folder; do
    [ -z "$kernel" ] && [ -x "$folder/linux-uml-$version" ] || continue
    kernel=$(folder_of "$folder")/linux-uml-$version
  done <<FOLDERS
$(set_folders)
FOLDERS
  [ -z "$kernel" ] || break
done
# shellcheck disable=SC2046  # the folders in one line
[ -n "$kernel" ] ||
  skip "no test kernel ${virtual:+6.12 }in" $(set_folders) "- './dev kernel' builds it"
if [ -n "$find" ]; then
  printf '%s\n' "$kernel"
  exit 0
fi

[ $# -gt 0 ] || die 'no command given'
[ -x "$init" ] || die "--init: no program '$init'"
init=$(folder_of "$(dirname -- "$init")")/$(basename -- "$init")

# ---- the run's own folder --------------------------------------------------------------------
# The kernel's state and its log, one folder per run: several beds run side by side.
run=$(mktemp -d /var/tmp/kagami-bed.XXXXXX) || die "no temporary folder in /var/tmp"
child=
end() {
  trap '' HUP INT TERM  # a second signal must not cut this short
  # shellcheck disable=SC2015  # neither may fail the end
  [ -n "$child" ] && kill "$child" 2>/dev/null && wait "$child" 2>/dev/null || true
  rm -rf "$run"
}
trap end EXIT
trap 'exit 129' HUP
trap 'exit 130' INT
trap 'exit 143' TERM
[ -n "$log" ] || log=$run/kernel.log

# working folder, number of words, words, environment: each ended by a zero byte.
# The consoles look like terminals to the command; colours would be noise.
{ printf '%s\0' "$(pwd)" $# "$@"; TERM=dumb env -0; } > "$run/job"

# The kernel's memory is a file that it executes from. Container managers make /dev/shm small and
# forbid that there; then a file on the disk serves, slower.
if ! shm=$(df -k --output=avail /dev/shm 2>/dev/null | tail -n 1) || [ "$shm" -lt 2097152 ] ||
    grep -q '^[^ ]* /dev/shm [^ ]* [^ ]*noexec' /proc/mounts; then
  export TMPDIR="$run"
else
  export TMPDIR=/dev/shm
fi

case $("$kernel" --version) in
  6.*) ;;
  *) arguments="seccomp=auto $arguments" ;;  # ptrace where this machine forbids it
esac
if [ -n "$virtual" ]; then
  arguments="time-travel=inf-cpu bed.settle $arguments"
fi

# Consoles: 0 is the command's stdout, 1 its stderr, the serial line the kernel's messages.
# In the background, so that a signal ends the kernel immediately.
rc=0
# shellcheck disable=SC2086  # arguments are words
${limit:+timeout -k 5 "$limit"} "$kernel" "mem=$memory" "uml_dir=$run" umid=bed \
  root=/dev/root rootfstype=hostfs rootflags=/ ro "init=$init" quiet \
  con=null con0=null,fd:1 con1=null,fd:2 ssl=null ssl0=null,fd:3 console=ttyS0 \
  $arguments "BED_JOB=$run/job" "BED_WRITABLE=$writable" </dev/null 3>"$log" &
child=$!
wait "$child" || rc=$?
case $rc in
  124) printf 'run_in_kernel: ended after %s s: %s\n' "$limit" "$*" >&2 ;;
  125|13[0-9]) printf 'run_in_kernel: the test kernel ended with %s:\n' "$rc" >&2
    tail -n 20 "$log" >&2 ;;
esac
exit "$rc"
