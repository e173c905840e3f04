#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A daemon that is killed in mid-drive begins again where the robot is, without being told; a damaged pose is ignored
# with a warning; the recording of the second run replays to the same bytes. usage: restart.sh FOLDER-OF-PROGRAMS
set -euo pipefail
bin=$1
source "$(dirname "${BASH_SOURCE[0]}")/two_ports.sh"
write_first_map
simulate

# start NAME [OPTION...]: a daemon that is up and has localized some scans
start() {
  local name=$1
  shift
  "$bin/deltamapd" "${on_the_world[@]}" --set map.store="$out/store.sqlite" --set control.socket="$out/ctl.sock" \
    --set localization.memory.pose_period_s=1 --out "$out/$name" "$@" 2>"$out/$name.log" &
  daemon=$!
  for _ in $(seq 400); do
    [[ -s $out/$name/trajectory.tum ]] && return
    kill -0 "$daemon" 2>/dev/null || fail "$name: the daemon has ended"
    sleep 0.1
  done
  fail "$name: no scan in time"
}

start first --initial-pose 1,2,0
ctl drive wander
sleep 10
ctl drive off
sleep 3  # it stands, and the pose that is kept is of now
kill -9 "$daemon" && wait "$daemon" 2>/dev/null || true
[[ -S $out/ctl.sock ]] || fail "a killed daemon leaves its socket behind: this test expects so"
[[ -s $out/store.pose.json ]] || fail "no pose was kept"

start second --set localization.initial_pose=null --set recording.file="$out/second.pcapng"
sleep 2
ctl status --json >"$out/stands.json"
grep -q '"drive_switch":"off by the operator"' "$out/stands.json" || fail "what an operator switched off is on again"
ctl drive wander
sleep 6
ctl status --json >"$out/status.json"
grep -q '"drive":"wander"' "$out/status.json" || fail "it does not drive though an operator has said so"
kill "$daemon" && wait "$daemon" || fail "the second daemon did not end well"
grep -q 'begins at the pose that was kept' "$out/second.log" || fail "the pose that was kept is not used"
grep -q '"state":"tracking"' "$out/status.json" || fail "the robot is not found again"
# The first second is for checking it.
tail -n +10 "$out/second/trajectory.tum" >"$out/settled.tum"
worst=$("$bin/deltamap" score --truth "$out/truth.jsonl" --world "$world" --trajectory "$out/settled.tum" \
  --start-map "$out/m0.yaml" --map "$out/second/map.yaml" --json | sed -n 's/^ *"max_m": \([0-9.]*\).*/\1/p')
awk -v worst="$worst" 'BEGIN { exit !(worst != "" && worst < 0.3) }' || fail "after the restart it is ${worst:-?} m off"

# From M_0 and the recording alone: what the run began from stands in it.
"$bin/deltamap" replay "$out/second.pcapng" --map "$out/m0.yaml" --config config/simulation.yaml --out "$out/again" \
  --set localization.initial_pose=null >"$out/replay.log" 2>&1 || fail "the recording does not replay"
grep -q 'journal obeyed; began with what the recorded run began from: .*kept pose' "$out/replay.log" || fail "not obeyed"
for file in trajectory.tum localization.csv changes.jsonl map.pgm; do
  cmp "$out/second/$file" "$out/again/$file" || fail "the replay of the second run differs"
done

echo 'not a pose' >"$out/store.pose.json"
start third --set localization.initial_pose=null
kill "$daemon" && wait "$daemon" || fail "the third daemon did not end well"
daemon=
grep -q 'warning no pose to begin with: .*store.pose.json: holds no pose' "$out/third.log" || fail "no warning"
[[ $(cat "$out/store.pose.json") == "not a pose" ]] || fail "a pose was kept before the robot was found"
grep -q 'localizer: global' "$out/third.log" || fail "it does not begin with global localization"
echo "restart: after kill -9 at most $worst m off"
