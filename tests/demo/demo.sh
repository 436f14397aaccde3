#!/bin/sh
# ./dev demo: the real programs, end to end. kagami-emulator plays the cameras, kagamid is the box,
# a script presses the buttons, and kagami turns what was recorded into a report and a film.
# POSIX sh; everything it started has ended when it ends.
set -eu

usage() {
  cat <<'TEXT'
Usage: ./dev demo [OPTIONS]

Runs the whole box on emulated GigE Vision cameras: live, delayed, frozen, sweep. The cameras see an
athlete at practice; the first time that scene is drawn, which takes up to a minute. Exits non-zero
when frames were lost or the machine could not keep the emulated cameras' times (then nothing is
said about losses).

  --seconds S     length of each run (default 60)
  --cameras N     cameras in the studio or the stamp scene (default 20)
  --size WxH      their size in pixels (default 1280x1024)
  --fps F         trigger rate (default 40)
  --scene SCENE   studio (default); stamp: every frame carries its number, then a screen of full
                  size; recording: real videos; all: these three one after the other; or a
                  folder with videos and rig.toml
  --out DIR       where film, stills and reports go (default out/demo)
  --report FILE   also copy report.json of the first scene there
  --depth         the studio has a depth sensor, too, and kagamid takes its pictures; a line says how
                  it fared (docs/depth.md). It costs a fifth of a processor
  --interactive   keys of this terminal instead of the script; ends with Ctrl-C

The recording is looked for in $KAGAMI_DATA_DIR, else in ../shared/data beside this folder.
TEXT
}

say() { printf 'demo: %s\n' "$*"; }
fail() { printf 'demo: %s\n' "$*" >&2; exit 1; }

root=$(cd -- "$(dirname -- "$0")/../.." && pwd)
bin=$root/build/release/bin
rate_of_recording=30   # Hz: a 1 Gb/s link carries at most 55 of its portrait frames a second

zoom=1.0
warm_up=2  # seconds in which losses are reported and not judged: all programs are new to the processors
emulator_patience=600  # tenths of a second
picture=1280x720
filmed=yes
seconds=60
cameras=20
size=1280x1024
fps=40
scene=studio
out=out/demo
report=
interactive=
depth=
while [ $# -gt 0 ]; do
  case $1 in
    -h|--help) usage; exit 0 ;;
    --interactive) interactive=yes; shift; continue ;;
    --depth) depth=yes; shift; continue ;;
    --seconds|--cameras|--size|--fps|--scene|--out|--report) ;;
    *) fail "unknown option '$1'; ./dev demo --help" ;;
  esac
  [ $# -ge 2 ] || fail "$1 needs a value; ./dev demo --help"
  case $1 in
    --seconds) seconds=$2 ;;
    --cameras) cameras=$2 ;;
    --size) size=$2 ;;
    --fps) fps=$2 ;;
    --scene) scene=$2 ;;
    --out) out=$2 ;;
    --report) report=$2 ;;
  esac
  shift 2
done

whole_number() {  # NAME VALUE
  case $2 in ''|*[!0-9]*|0*) fail "$1 $2: a whole number above 0 is needed" ;; esac
}
whole_number --seconds "$seconds"
whole_number --cameras "$cameras"
case $size in
  [1-9]*x[1-9]*) ;;
  *) fail "--size $size: WIDTHxHEIGHT is needed, for instance 1280x1024" ;;
esac
printf '%s\n' "$fps" | grep -Eq '^[0-9]+(\.[0-9]+)?$' || fail "--fps $fps: a number is needed"
[ -z "$interactive" ] || [ -t 0 ] || fail '--interactive needs a terminal on standard input'
for program in kagami-emulator kagamid kagami; do
  [ -x "$bin/$program" ] || fail "$program is not built: ./dev build"
done

# ---- processes -----------------------------------------------------------------------------
emulator=
daemon=
bus_daemon=
stopped=

ended() { ! kill -0 "$1" 2>/dev/null; }

# A process that does not end by itself within the time is killed: nothing stays behind.
end_process() {  # PID TENTHS
  [ -n "$1" ] || return 0
  kill -TERM "$1" 2>/dev/null || true
  left=$2
  while [ "$left" -gt 0 ] && ! ended "$1"; do
    sleep 0.1
    left=$((left - 1))
  done
  kill -KILL "$1" 2>/dev/null || true
}

cleanup() {
  end_process "$daemon" 100
  end_process "$emulator" 50
  end_process "$bus_daemon" 20
  keep_run
}
trap cleanup EXIT
trap 'exit 129' HUP
trap 'exit 143' TERM
if [ -n "$interactive" ]; then
  trap 'stopped=yes' INT  # Ctrl-C is how an interactive run ends: the report comes after it
else
  trap 'exit 130' INT
fi

# The last lines of a program that failed, then what to do about it.
broken() {  # PROGRAM LOG ADVICE
  printf 'demo: %s failed; its last lines:\n' "$1" >&2
  tail -n 12 "$2" | sed 's/^/    /' >&2
  fail "$3 (whole log: $2)"
}

wait_for_line() {  # PID LOG PATTERN TENTHS: 1 when it did not come
  left=$4
  while ! grep -qs "$3" "$2"; do
    if [ "$left" = 0 ] || ended "$1"; then
      grep -qs "$3" "$2" || return 1
    fi
    sleep 0.1
    left=$((left - 1))
  done
}

# ---- the folder of a run ---------------------------------------------------------------------
# A run writes into memory where there is room, so that no disk works on the measured processors;
# FOLDER/run leads there meanwhile and is the folder itself afterwards.
scratch=
scratch_parent=/dev/shm  # what is made there has our process id in its name
scratch_kib=2097152  # film and trace of a run of ten minutes

# A demo that was killed could not remove what it had there.
remove_stale() {
  for path in "$scratch_parent"/kagami-demo.*.* "$scratch_parent"/kagami-demo-depth.*; do
    [ -O "$path" ] || continue
    owner=${path#"$scratch_parent"/kagami-demo*.}
    owner=${owner%%.*}
    case $owner in ''|*[!0-9]*) continue ;; esac
    [ -d "/proc/$owner" ] || rm -rf "$path"
  done
}

make_run() {  # FOLDER
  rm -rf "$1/run"
  mkdir -p "$1"
  free_kib=$(df -kP "$scratch_parent" 2>/dev/null | awk 'NR == 2 { print $4 }')
  if [ "${free_kib:-0}" -ge "$scratch_kib" ]; then
    scratch=$(mktemp -d "$scratch_parent/kagami-demo.$$.XXXXXX") || scratch=
  fi
  if [ -n "$scratch" ]; then ln -s "$scratch" "$1/run"; else mkdir "$1/run"; fi
  scratch_link=$1/run
  mkdir -p "$1/run/pictures" "$1/run/state"
}

keep_run() {
  [ -n "$scratch" ] || return 0
  chmod 755 "$scratch"
  rm -f "$scratch_link"
  mv "$scratch" "$scratch_link" || say "what was recorded stays in $scratch until the next demo" >&2
  scratch=
}

# ---- one scene -----------------------------------------------------------------------------
# The panel script in whole rounds over the run's seconds.
panel_script() {
  awk -v seconds="$seconds" '
    BEGIN { lines = 0 }
    $1 == "#" && $2 == "phase" { phase[lines] = 1; time[lines] = $3
                                 sub(/^# phase [0-9.]+ /, ""); text[lines++] = $0; next }
    /^#/ || NF == 0 { next }
    { time[lines] = $1; sub(/^[0-9.]+ /, ""); text[lines++] = $0 }
    END {
      rounds = int(seconds / 60); if (rounds < 1) rounds = 1
      for (round = 0; round < rounds; ++round)
        for (i = 0; i < lines; ++i) {
          at = (round + time[i] / 60) * seconds / rounds
          if (phase[i]) printf "# phase %.3f %s\n", at, text[i]
          else printf "%.3f %s\n", at, text[i]
        }
    }' "$root/tests/demo/panel.txt"
}

phase_at() {  # SECOND SCRIPT
  awk -v now="$1" '$2 == "phase" && $3 <= now { sub(/^# phase [0-9.]+ /, ""); name = $0 }
    END { print name }' "$2"
}

# The studio's depth sensor, if one is asked for, and a bus of our own to ask the box about it.
sensor_of_run=
bus=none

plug_sensor_in() {  # RUN-FOLDER
  sensor_of_run=yes
  export KAGAMI_DEPTH_RING="$scratch_parent/kagami-demo-depth.$$"
  command -v dbus-daemon >/dev/null 2>&1 || return 0
  bus=unix:path=$1/bus
  dbus-daemon --session --nofork --nopidfile --address="$bus" >/dev/null 2>&1 </dev/null &
  bus_daemon=$!
  left=50
  while [ ! -S "$1/bus" ] && [ "$left" -gt 0 ]; do sleep 0.1; left=$((left - 1)); done
}

tell_of_sensor() {
  [ "$bus" != none ] || return 0
  "$bin/kagami" --bus "$bus" status 2>/dev/null | sed -n 's/^depth  */demo: depth sensor /p'
  end_process "$bus_daemon" 20
  bus_daemon=
}

# Only what differs from the daemon's defaults. The screen ticks at a multiple of the rate.
write_config() {  # RUN-FOLDER RATE
  addresses=$(awk '/^\[\[camera\]\]/ { printf "%s\"127.0.0.%d\"", n ? ", " : "", n + 1; ++n }' \
    "$1/rig.toml")
  refresh_hz=$(awk -v rate="$2" 'BEGIN { n = 1; while (n * rate < 60) ++n; printf "%.3f", n * rate }')
  record=
  [ -z "$filmed" ] || record=$1/pictures
  panel=scripted
  [ -z "$interactive" ] || panel=terminal
  cat <<TEXT
[rig]
file = "$1/rig.toml"
[cameras]
addresses = [$addresses]
[trigger]
rate_hz = $2
genlock = false  # this screen has no true vblanks, and a wait for them would count as work
[display]
width_px = ${picture%x*}
height_px = ${picture#*x}
refresh_hz = $refresh_hz
zoom = $zoom
[panel]
backend = "$panel"
script = "$1/panel.txt"
[record]
directory = "$record"
video_hz = 10
[state]
directory = "$1/state"
trace = "$1/trace.jsonl"
[control]
bus = "$bus"
TEXT
  [ -z "$sensor_of_run" ] || cat <<TEXT
[depth_sensor]
backend = "openni"
drivers = "$root/build/release/depth-drivers"
TEXT
}

start_emulator() {  # RUN-FOLDER OPTION...
  run=$1; shift
  # Hardware is never late for want of a processor: the emulated cameras stand above the daemon.
  # Lateness counts from when lost frames do.
  "$bin/kagami-emulator" "$@" --realtime-priority 85 --warm-up-s "$warm_up" \
    --wire-log "$run/wire.csv" --stats "$run/emulator.json" > "$run/emulator.log" 2>&1 </dev/null &
  emulator=$!
  wait_for_line "$emulator" "$run/emulator.log" '^ready' "$emulator_patience" ||
    broken kagami-emulator "$run/emulator.log" 'its message says what to do'
}

start_daemon() {  # RUN-FOLDER
  exec 3<&0
  "$bin/kagamid" --config "$1/kagamid.toml" > "$1/kagamid.log" 2>&1 <&3 &
  daemon=$!
  exec 3<&-
  wait_for_line "$daemon" "$1/kagamid.log" 'running: ' 900 ||
    broken kagamid "$1/kagamid.log" 'its message says what to do'
  # What is less than configured, and the keys of an interactive run.
  sed -n 's/^warning: /demo: kagamid: /p; s/^keys: /demo: keys: /p' "$1/kagamid.log"
}

watch_run() {  # RUN-FOLDER
  second=0
  while [ "$second" -lt "$seconds" ] || [ -n "$interactive" ]; do
    [ -z "$stopped" ] || return 0
    ! ended "$daemon" || broken kagamid "$1/kagamid.log" 'it ended in the middle of the run'
    ! ended "$emulator" ||
      broken kagami-emulator "$1/emulator.log" 'it ended in the middle of the run'
    if [ -z "$interactive" ] && [ $((second % 5)) = 0 ]; then
      say "$second of $seconds s: $(phase_at "$second" "$1/panel.txt")"
    fi
    sleep 1 || true
    second=$((second + 1))
  done
}

stop_programs() {  # RUN-FOLDER
  rc=0
  kill -TERM "$daemon" 2>/dev/null || true
  wait "$daemon" || rc=$?
  daemon=
  [ "$rc" = 0 ] || broken kagamid "$1/kagamid.log" "it did not end well (exit status $rc)"
  kill -TERM "$emulator" 2>/dev/null || true
  wait "$emulator" || rc=$?
  emulator=
  [ "$rc" = 0 ] ||
    broken kagami-emulator "$1/emulator.log" "it did not end well (exit status $rc)"
}

# Processor time of this machine so far: all, idle, taken by its host; hundredths of a second.
processor_time() {
  awk '$1 == "cpu" { all = 0; for (i = 2; i <= 9; ++i) all += $i; print all, $5 + $6, $9 }' /proc/stat
}

# What the machine was like meanwhile, so that a reader can distinguish a bad hour of it from a bad build.
tell_of_machine() {  # PROCESSOR-TIME-BEFORE EMULATOR-STATISTICS
  printf '%s\n%s\n' "$1" "$(processor_time)" | awk -v statistics="$2" '
    NR == 1 { all = $1; idle = $2; taken = $3 }
    END {
      all = $1 - all
      if (all > 0) printf "demo: this machine was idle for %.0f %% of the run, and its host took %.1f %%\n",
        100 * ($2 - idle) / all, 100 * ($3 - taken) / all
      while ((getline line < statistics) > 0) {
        if (line ~ /"warm_up"/) early = 1
        if (line !~ /"(p99|max)"/) continue
        name = line ~ /p99/ ? "p99" : "max"; sub(/.*: */, "", line); late[early + 0, name] = line / 1e6
      }
      printf "demo: the emulated cameras were late by %.1f ms at p99, %.1f ms at most; in the warm-up %.1f ms\n",
        late[0, "p99"], late[0, "max"], late[1, "max"]
    }'
}

# What makes a run bad, a line each; nothing for a good one. What was lost while this PC stood still is
# no fault of the build; the table says how much that was.
faults_of() {  # REPORT
  awk '
    function number() { sub(/.*: */, ""); sub(/,$/, ""); return $0 + 0 }
    /^  "valid": true/ { valid = 1 }
    /^  "after_warm_up"/ { judged = 1 }
    /^  }/ { judged = 0 }
    judged && /"frames_expected"/ { expected = number() }
    judged && /"frames_lost"/ { lost += number() }
    judged && /"frames_incomplete"/ { incomplete += number() }
    judged && /"frames_lost_in_stalls"/ { lost -= number() }
    judged && /"frames_incomplete_in_stalls"/ { incomplete -= number() }
    END {
      if (!valid) print "the run is not valid, the table says why"
      if (expected == 0) print "no frame was expected after the warm-up: run longer (--seconds)"
      if (lost > 0) print lost " frames lost"
      if (incomplete > 0) print incomplete " frames incomplete"
    }' "$1"
}

make_report() {  # FOLDER
  "$bin/kagami" report --trace "$1/run/trace.jsonl" --wire-log "$1/run/wire.csv" \
    --emulator-stats "$1/run/emulator.json" --warm-up "$warm_up" \
    --out "$1/report.json" --table > "$1/report.txt" ||
    fail "kagami report failed (above) on $1/run/trace.jsonl"
}

judge() {  # NAME FOLDER
  faults=$(faults_of "$2/report.json")
  if [ -n "$faults" ]; then
    printf '%s\n' "$faults" | sed "s/^/demo: $1: NOT GOOD: /" >&2
    verdict=1
  fi
}

# Report and film are made from what was recorded, whatever the verdict.
conclude() {  # NAME FOLDER
  run=$2/run
  make_report "$2"
  cat "$2/report.txt"
  say "$1: making the film"
  "$bin/kagami" film --record "$run/pictures" --out "$2/demo.mp4" \
    --contact-sheet "$2/contact-sheet.png" > "$run/film.log" 2>&1 ||
    broken 'kagami film' "$run/film.log" "the pictures are in $run/pictures"
  for mode in live delayed frozen sweep; do
    rm -f "$2/$mode.png"
    still=$run/pictures/$mode.png
    # A sweep leaves one still of each view it passed.
    [ "$mode" != sweep ] || still=$(ls "$run"/pictures/view*.png 2>/dev/null | sed -n 2p)
    [ ! -f "$still" ] || cp "$still" "$2/$mode.png"
  done
  say "$1: demo.mp4, stills, contact-sheet.png, report.json and report.txt are in $2"
  judge "$1" "$2"
}

run_scene() {  # NAME FOLDER RATE EMULATOR-OPTION...
  name=$1; folder=$2; rate=$3; shift 3
  run=$folder/run
  make_run "$folder"
  panel_script > "$run/panel.txt"
  if [ -n "$depth" ] && [ "$name" = studio ]; then
    plug_sensor_in "$run"
    set -- "$@" --depth-sensor
  fi
  say "$name: starting the emulated cameras"
  start_emulator "$run" "$@"
  [ -f "$run/rig.toml" ] || cp "$scene_folder/rig.toml" "$run/rig.toml"
  write_config "$run" "$rate" > "$run/kagamid.toml"
  say "$name: starting kagamid, which takes the memory of its history first"
  start_daemon "$run"
  time_before=$(processor_time)
  watch_run "$run"
  tell_of_sensor
  stop_programs "$run"
  tell_of_machine "$time_before" "$run/emulator.json"
  keep_run
  conclude "$name" "$folder"
}

run_stamp() {  # FOLDER
  run_scene stamp "$1" "$fps" --scene stamp --cameras "$cameras" --size "$size" \
    --rig-out "$1/run/rig.toml"
  [ -n "$interactive" ] || run_full_hd "$1"
}

# What was drawn stays in the user's cache, so only the first run waits for it. The emulator draws on
# when no camera sends; kagami-studio draw makes the whole play in one run.
run_studio() {  # FOLDER
  say 'studio: the first time the hall is drawn, up to a minute'
  usual_patience=$emulator_patience
  usual_zoom=$zoom
  emulator_patience=3000
  zoom='"cover"'  # as the box does by itself: the hall fills the screen
  run_scene studio "$1" "$fps" --scene studio --cameras "$cameras" --size "$size" \
    --rig-out "$1/run/rig.toml" --studio-truth "$1/truth"
  emulator_patience=$usual_patience
  zoom=$usual_zoom
  sensor_of_run=
  bus=none
}

# How many frame sets a second the same cameras give on a screen of full size: live, not filmed.
run_full_hd() {  # FOLDER
  run=$1/full-hd/run
  usual="picture=$picture filmed=$filmed seconds=$seconds"
  picture=1920x1080
  filmed=
  [ "$seconds" -le 20 ] || seconds=20
  make_run "$1/full-hd"
  echo '# phase 0 live' > "$run/panel.txt"
  say "full size: the same cameras on a screen of $picture"
  start_emulator "$run" --scene stamp --cameras "$cameras" --size "$size" --rig-out "$run/rig.toml"
  write_config "$run" "$fps" > "$run/kagamid.toml"
  start_daemon "$run"
  watch_run "$run"
  stop_programs "$run"
  keep_run
  make_report "$1/full-hd"
  awk '/^shown:/ { rate = $2 } /^after/ { lost = $(NF - 3) }
    END { printf "highest sustained rate at 1920x1080: %s frame sets a second (%s frames lost)\n",
      rate, lost }' "$1/full-hd/report.txt" | tee -a "$1/report.txt"
  judge 'full size' "$1/full-hd"
  eval "$usual"
}

run_folder() {  # NAME FOLDER RATE SCENE-FOLDER
  scene_folder=$4
  [ -f "$4/rig.toml" ] || fail "scene $4: there is no rig.toml in it (docs/emulator.md)"
  run_scene "$1" "$2" "$3" --scene "$4"
}

# The recording as the emulator wants it, made once and kept outside the source tree.
convert_recording() {  # prints the folder; 3 when there is no recording
  source=${KAGAMI_DATA_DIR:-$root/../shared/data}/pose2sim_single
  [ -d "$source" ] || return 3
  converted=${XDG_CACHE_HOME:-${HOME:-/var/tmp}/.cache}/kagami/pose2sim_single
  if [ ! -f "$converted/rig.toml" ]; then
    say 'recording: converting, once' >&2
    rm -rf "$converted.new" "$converted"
    mkdir -p "$(dirname "$converted")"
    "$bin/kagami-emulator" convert pose2sim "$source" "$converted.new" >&2 ||
      fail "the recording in $source cannot be converted (above)"
    mv "$converted.new" "$converted"
  fi
  printf '%s\n' "$converted"
}

run_recording() {  # FOLDER
  rc=0
  folder_of_recording=$(convert_recording) || rc=$?
  case $rc in
    0) ;;
    3) [ "$scene" = all ] || fail 'no recording: set KAGAMI_DATA_DIR to the folder that holds it'
      say 'recording: none in $KAGAMI_DATA_DIR or ../shared/data: left out'
      return 0 ;;
    *) exit "$rc" ;;
  esac
  zoom=1.5  # portrait pictures: the athlete fills the height
  run_folder recording "$1" "$rate_of_recording" "$folder_of_recording"
}

# ---- what was asked for --------------------------------------------------------------------
remove_stale
mkdir -p "$out" || fail "--out $out cannot be made"
out=$(cd -- "$out" && pwd)
verdict=0
case $scene in
  studio) run_studio "$out" ;;
  stamp) run_stamp "$out" ;;
  recording) run_recording "$out" ;;
  all)
    run_studio "$out"
    [ -n "$stopped" ] || run_stamp "$out/stamp"
    [ -n "$stopped" ] || run_recording "$out/recording"
    ;;
  *) run_folder scene "$out" "$fps" "$scene" ;;
esac
if [ -n "$report" ]; then
  cp "$out/report.json" "$report" || fail "--report $report cannot be written"
fi
exit "$verdict"
