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
# started_with PORTS: the words of a daemon's start
started_with() {
  printf '%s\n' env "${signals_at_start[@]}" "$bin/deltamapd" "${on_the_world[@]}" --set robot.port="$1/robot" --set laser.port="$1/laser" \
    --set map.store= --set recording.file= --set control.socket="$out/ctl.sock" --initial-pose 1,2,0 --out "$out/run"
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
  mapfile -t words < <(started_with "$1")
  printf -v words '%q ' "${words[@]}"
  script --quiet --command "echo \$\$ >$out/pid; exec $words 2>$out/daemon.log" /dev/null >/dev/null 2>&1 </dev/null &
  terminal=$!
  for _ in $(seq 100); do [[ -s $out/pid ]] && break; sleep 0.1; done
  daemon=$(<"$out/pid")
  answers
}
answers() {
  for _ in $(seq 100); do
    ctl status >/dev/null 2>&1 && return
    kill -0 "$daemon" 2>/dev/null || fail "the daemon has ended"
    sleep 0.1
  done
  fail "the daemon does not answer"
}
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
ctl status >/dev/null || fail "a signal that was ignored at the start was not"
kill "$daemon"
stopped TERM
signals_at_start=(--default-signal=HUP,INT,QUIT)

start "$out/none"
for signal in PIPE XFSZ TSTP TTIN TTOU; do kill -s "$signal" "$daemon"; done
sleep 1.5
ctl status >/dev/null || fail "a signal that is to be ignored was not"
kill "$daemon"
stopped TERM

simulate
start_on_terminal "$out"
ctl drive wander >/dev/null
sleep 8
[[ $(ctl status --json) == *'"drive":"wander"'* ]] || fail "it does not drive"
kill -9 "$terminal"
wait "$terminal" 2>/dev/null || true
for _ in $(seq 100); do kill -0 "$daemon" 2>/dev/null || break; sleep 0.1; done
! kill -0 "$daemon" 2>/dev/null || fail "its terminal is gone, and it runs on"
stopped_in_order HUP
sleep 0.5
# The true pose and speed.
where() { grep -o '"pose":.*' "$out/truth.jsonl" | tail -n 1; }
before=$(where)
sleep 1.5
[[ -n $before && $(where) == "$before" ]] || fail "the robot drives on: $before, then $(where)"
echo "signals: 14 stop the daemon in order, 5 do nothing, nor do 3 that were ignored at its start; its terminal gone, the robot stands at $before"
