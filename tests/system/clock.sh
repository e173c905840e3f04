#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The clock of the machine jumps an hour on and two hours back while the robot drives: the daemon goes on, the pose stays
# and its times follow the start of the run; only the log shows the clock. usage: clock.sh FOLDER-OF-PROGRAMS SHIM
set -euo pipefail
bin=$1
shim=$(realpath "$2")
source "$(dirname "${BASH_SOURCE[0]}")/two_ports.sh"
write_first_map

# jump HOURS: the clock is wrong by so much from now on
jump() { python3 -c 'import struct, sys; open(sys.argv[1], "r+b").write(struct.pack("=q", 3600 * int(sys.argv[2])))' "$out/offset" "$1"; }
head -c 8 /dev/zero >"$out/offset"
simulate
LD_PRELOAD=$shim JUMPING_CLOCK=$out/offset "$bin/deltamapd" "${on_the_world[@]}" "${slowly[@]}" --set map.store="$out/store.sqlite" \
  --set recording.file="$out/run.pcapng" --set control.socket="$out/ctl.sock" --initial-pose 1,2,0 --out "$out/run" 2>"$out/daemon.log" &
daemon=$!
await "no scan in time" test -s "$out/run/trajectory.tum"
await "it does not drive" does drive wander
for hours in 0 1 -1; do
  jump "$hours"
  localizes 50
  await "nothing is saved with a clock that is wrong by $hours h" does save
done
await "it does not drive with a clock that was wrong" tells '"drive":"wander"'
await "it is not told to stand" does drive off
await "the pose is lost" tells '"state":"tracking"'
kill "$daemon" && wait "$daemon" || fail "the daemon did not end well"
daemon=
[[ $(cut -c1-2 "$out/daemon.log" | sort -u | grep -c '^[0-9]') -ge 3 ]] || fail "the clock did not jump"
# Five minutes without a scan are no jump of an hour.
awk 'NR > 1 && ($1 <= last || $1 - last > 300) { exit 1 } { last = $1 }' "$out/run/trajectory.tum" || fail "the times of the poses jump"
tail -n +10 "$out/run/trajectory.tum" >"$out/settled.tum"
worst=$("$bin/deltamap" score --truth "$out/truth.jsonl" --world "$world" --trajectory "$out/settled.tum" \
  --start-map "$out/m0.yaml" --map "$out/run/map.yaml" --json | sed -n 's/^ *"max_m": \([0-9.]*\).*/\1/p')
awk -v worst="$worst" 'BEGIN { exit !(worst != "" && worst < 0.3) }' || fail "it is ${worst:-?} m off"
"$bin/deltamap" replay "$out/run.pcapng" --map "$out/m0.yaml" --config config/simulation.yaml --initial-pose 1,2,0 "${slowly[@]}" --out "$out/again" >"$out/replay.log" 2>&1 ||
  fail "the recording does not replay"
cmp "$out/run/trajectory.tum" "$out/again/trajectory.tum" || fail "the replay differs"
echo "clock: at most $worst m off while it jumped"
