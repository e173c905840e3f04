#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A disk that is full for half a minute of a drive: saving pauses, localization and mapping go on, and afterwards store,
# map, recording and lines are whole. Needs root for a file system of its own. usage: full_disk.sh FOLDER-OF-PROGRAMS
set -euo pipefail
bin=$1
source "$(dirname "${BASH_SOURCE[0]}")/two_ports.sh"
disk=$out/disk
clean_up() { umount "$disk" 2>/dev/null || true; }
mkdir "$disk"
if ! mount -t tmpfs -o size=12m tmpfs "$disk" 2>/dev/null; then
  echo "full_disk: SKIPPED: nothing can be mounted here (run it as root)" >&2
  exit 77
fi

write_first_map
simulate --change-every 10
mkdir "$disk/run"
"$bin/deltamapd" "${on_the_world[@]}" --set map.store="$disk/store.sqlite" --set recording.file="$disk/bytes.pcapng" \
  --set control.socket="$out/ctl.sock" --set localization.memory.pose_period_s=0.5 --set mapping.persistence_s=3 \
  --initial-pose 1,2,0 --out "$disk/run" 2>"$out/daemon.log" &
daemon=$!
patience_s=600  # a change of the world must lie where the robot comes by
# drives_to REVISION: a robot whose connection has broken off may need the word again
drives_to() { tells '"drive":"wander"' || does drive wander; reached newest_revision "$1"; }
await "no scan in time" reached localized 1
await "no revision" drives_to 1

fill() {
  dd if=/dev/zero bs=4k 2>/dev/null >>"$disk/filler" || true
  while printf x >>"$disk/filler" 2>/dev/null; do :; done 2>/dev/null
}
# not_paused: the first output that is not said to pause
not_paused() {
  ctl status >"$out/status.log"
  for name in trajectory localization map store history recording pose; do  # a line of changes may fit
    grep -q " $name not since .* UTC: .*\(No space left\|full\)" "$out/status.log" || { echo "$name"; return; }
  done
}
fill
known() { full_at=$(number newest_revision); ((full_at > 0)); }
await "no status" known
await "no revision while the disk is full" drives_to $((full_at + 2))
all_pause() { fill; [[ -z $(not_paused) ]]; }  # a file that is replaced leaves some room for a moment
await "not all is said to pause" all_pause
localizes 100
[[ $(grep -c 'warning saving pauses: store' "$out/daemon.log") == 1 ]] || fail "not one warning of the store"

rm "$disk/filler"
goes_on() { ctl status >"$out/status.log" && ! grep -q ' not since ' "$out/status.log"; }
await "saving does not go on" goes_on
kill "$daemon"
wait "$daemon" || fail "exit code $?"
daemon=

newest=$("$bin/deltamap" map history "$disk/store.sqlite" list --json | grep '"refused":false' | tail -n 1 |
  grep -o '"number":[0-9]*' | cut -d: -f2)
[[ $newest -ge $((full_at + 2)) ]] || fail "the store holds revision $newest of more than $full_at"
"$bin/deltamap" map history "$disk/store.sqlite" list | grep -q ' in one)' || fail "nothing was stored whole"
"$bin/deltamap" map history "$disk/store.sqlite" export "$newest" "$out/newest.yaml"
cmp "$out/newest.pgm" "$disk/run/map.pgm" || fail "the store's newest map is not the map"
awk 'NF != 8 { exit 1 }' "$disk/run/trajectory.tum" || fail "a line of the trajectory is cut"
awk -F, 'NR == 1 { n = NF } NF != n { exit 1 }' "$disk/run/localization.csv" || fail "a line of localization.csv is cut"
scans=$(grep -m 1 -o '^ *"scans": [0-9]*' "$disk/run/report.json" | grep -o '[0-9]*$')
[[ $(wc -l <"$disk/run/trajectory.tum") == "$scans" ]] || fail "lines were lost although there was room to wait"
"$bin/deltamap" replay "$disk/bytes.pcapng" --map "$out/m0.yaml" --config config/simulation.yaml --initial-pose 1,2,0 \
  --out "$out/again" >"$out/replay.log" 2>&1 || fail "the recording cannot be replayed"
grep -q 'not obeyed: records are missing' "$out/again/report.json" || fail "the replay claims to reproduce"
echo "full_disk: full from revision $full_at on; afterwards the store holds revision $newest, which is the map"
