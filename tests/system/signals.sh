#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# No signal but SIGKILL ends the daemon without a word to the robot: each that would stops it in order, with report and
# exit code 0; a terminal that goes away stops a robot that drives. Without a terminal SIGHUP is another matter: reload.sh.
# usage: signals.sh FOLDER-OF-PROGRAMS
set -euo pipefail
bin=$1
source "$(dirname "${BASH_SOURCE[0]}")/two_ports.sh"
write_first_map

signals_at_start=(--default-signal=HUP,INT,QUIT)
# started_with PORTS [RECORDING]: the words of a daemon's start
started_with() {
  printf '%s\n' env "${signals_at_start[@]}" "$bin/deltamapd" "${on_the_world[@]}" --set robot.port="$1/robot" --set laser.port="$1/laser" \
    --set map.store= --set recording.file="${2:-}" --set control.socket="$out/ctl.sock" --initial-pose 1,2,0 --out "$out/run"
}
# start PORTS: a daemon that answers, without a terminal
start() {
  local words
  rm -rf "$out/run"
  mapfile -t words < <(started_with "$1")
  # The & of a script leaves INT and QUIT ignored, and what is ignored at the start stays so.
  setsid "${words[@]}" 2>"$out/daemon.log" &
  daemon=$!
  answers
}
# start_on_terminal PORTS: the same on a terminal of its own, held by $terminal
start_on_terminal() {
  local words
  rm -rf "$out/run"
  mapfile -t words < <(started_with "$1" "$out/bytes.pcapng")
  printf -v words '%q ' "${words[@]}"
  script --quiet --command "echo \$\$ >$out/pid; exec $words 2>$out/daemon.log" /dev/null >/dev/null 2>&1 </dev/null &
  terminal=$!
  await "no daemon on the terminal" test -s "$out/pid"
  daemon=$(<"$out/pid")
  answers
}
answers() { await "the daemon does not answer" does status; }
# stopped SIGNAL: it has ended, and in order
stopped() {
  local code=0
  wait "$daemon" || code=$?
  [[ $code == 0 ]] || fail "SIG$1: exit code $code"
  stopped_in_order "$1"
}
stopped_in_order() {
  daemon=
  [[ -s $out/run/report.json ]] || fail "SIG$1: no report"
  grep -q 'stopped: ' "$out/daemon.log" || fail "SIG$1: no last line"
}

signals="INT QUIT TERM USR1 USR2 ALRM VTALRM PROF IO PWR STKFLT XCPU RTMIN RTMAX"
for signal in $signals; do
  start "$out/none"
  kill -s "$signal" "$daemon"
  stopped "$signal"
done

signals_at_start=(--ignore-signal=HUP,INT,QUIT)
start "$out/none"
for signal in HUP INT QUIT; do kill -s "$signal" "$daemon"; done
sleep 1.5
await "a signal that was ignored at the start was not" does status
kill "$daemon"
stopped TERM
signals_at_start=(--default-signal=HUP,INT,QUIT)

start "$out/none"
for signal in PIPE XFSZ TSTP TTIN TTOU; do kill -s "$signal" "$daemon"; done
sleep 1.5
await "a signal that is to be ignored was not" does status
kill "$daemon"
stopped TERM

simulate
start_on_terminal "$out"
await "it does not drive" does drive wander
await "nothing says that it drives" tells '"drive":"wander"'
await "it does not move" moves
kill -9 "$terminal"
wait "$terminal" 2>/dev/null || true
gone=$daemon
daemon=
await "its terminal is gone, and it runs on" has_ended "$gone"
stopped_in_order HUP
# The speeds that the robot was told, forward (VEL) and turning (RVEL).
told=$(python3 -c 'import re, sys
speeds = re.findall(rb"\xfa\xfb\x06[\x0b\x15][\x3b\x1b](..)", open(sys.argv[1], "rb").read(), re.DOTALL)
print(*(int.from_bytes(speed, "little") for speed in speeds))' "$out/bytes.pcapng")
[[ $told == *[1-9]* ]] || fail "it was never told to drive: $told"
[[ $told == *' 0' ]] || fail "the last speed that it was told is none of standing: $told"
await "the robot drives on" stands
echo "signals: 14 stop the daemon in order, 5 do nothing, nor do 3 that were ignored at its start; its terminal gone, the robot is told to stand"
