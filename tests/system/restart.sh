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
  "$bin/deltamapd" "${on_the_world[@]}" "${slowly[@]}" --set map.store="$out/store.sqlite" --set control.socket="$out/ctl.sock" \
    --set localization.memory.pose_period_s=1 --out "$out/$name" "$@" 2>"$out/$name.log" &
  daemon=$!
  await "$name: no scan in time" test -s "$out/$name/trajectory.tum"
}

start first --initial-pose 1,2,0
await "it does not drive" does drive wander
localizes 90
await "it is not told to stand" does drive off
await "it does not stand" stands
touch "$out/stood"
kept_since() { [[ $out/store.pose.json -nt $1 ]]; }
await "no pose of where it stands is kept" kept_since "$out/stood"
kill -9 "$daemon" && wait "$daemon" 2>/dev/null || true
[[ -S $out/ctl.sock ]] || fail "a killed daemon leaves its socket behind: this test expects so"
[[ -s $out/store.pose.json ]] || fail "no pose was kept"

start second --set localization.initial_pose=null --set recording.file="$out/second.pcapng"
await "no status" reached localized 20
await "what an operator switched off is on again" tells '"drive_switch":"off by the operator"'
await "it does not drive" does drive wander
localizes 60
await "it does not drive though an operator has said so" tells '"drive":"wander"'
await "the robot is not found again" tells '"state":"tracking"'
kill "$daemon" && wait "$daemon" || fail "the second daemon did not end well"
grep -q 'begins at the pose that was kept' "$out/second.log" || fail "the pose that was kept is not used"
# The first second is for checking it.
tail -n +10 "$out/second/trajectory.tum" >"$out/settled.tum"
worst=$("$bin/deltamap" score --truth "$out/truth.jsonl" --world "$world" --trajectory "$out/settled.tum" \
  --start-map "$out/m0.yaml" --map "$out/second/map.yaml" --json | sed -n 's/^ *"max_m": \([0-9.]*\).*/\1/p')
awk -v worst="$worst" 'BEGIN { exit !(worst != "" && worst < 0.3) }' || fail "after the restart it is ${worst:-?} m off"

# From M_0 and the recording alone: what the run began from stands in it.
"$bin/deltamap" replay "$out/second.pcapng" --map "$out/m0.yaml" --config config/simulation.yaml "${slowly[@]}" --out "$out/again" \
  --set localization.initial_pose=null >"$out/replay.log" 2>&1 || fail "the recording does not replay"
grep -q 'journal obeyed; began with what the recorded run began from: .*kept pose' "$out/replay.log" || fail "not obeyed"
for file in trajectory.tum localization.csv changes.jsonl map.pgm; do
  cmp "$out/second/$file" "$out/again/$file" || fail "the replay of the second run differs"
done

echo 'not a pose' >"$out/store.pose.json"
start third --set localization.initial_pose=null
await "it does not begin with global localization" said 'localizer: global' "$out/third.log"
kill "$daemon" && wait "$daemon" || fail "the third daemon did not end well"
daemon=
grep -q 'warning no pose to begin with: .*store.pose.json: holds no pose' "$out/third.log" || fail "no warning"
[[ $(cat "$out/store.pose.json") == "not a pose" ]] || fail "a pose was kept before the robot was found"
echo "restart: after kill -9 at most $worst m off"
