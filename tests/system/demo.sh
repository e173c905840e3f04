#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A robot and its laser, simulated byte for byte on two pseudo-terminals, and the daemon that keeps its map true.
# Called by ./dev demo; serves the live page until Ctrl-C, or for so many seconds; then tells the score and draws pictures. Leaves everything in
# build/demo.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

usage="usage: ./dev demo [--for SECONDS] [--seed N] [--world FILE] [--out DIR] [--page PORT] [--pin CPU]"
seconds="" seed=1 world=config/scenarios/demo.yaml out=build/demo bin=build/release/bin pin=() page=8484
while (($#)); do
  case $1 in
    --for) seconds=$2; shift 2 ;;
    --seed) seed=$2; shift 2 ;;
    --world) world=$2; shift 2 ;;
    --out) out=$2; shift 2 ;;
    --page) page=$2; shift 2 ;;  # port of the live page; 0: none
    --pin) pin=(taskset -c "$2"); shift 2 ;;  # the daemon on one processor, as on the netbook
    -h | --help) echo "$usage"; exit 0 ;;
    *) echo "$usage" >&2; exit 2 ;;
  esac
done

limit=() until=", until Ctrl-C"
if [[ $seconds ]]; then
  limit=(timeout --foreground --preserve-status -s TERM "$seconds") until=""
fi

rm -rf "$out"
mkdir -p "$out"
"$bin/deltamap" sim --world "$world" --write-map "$out/m0.yaml"
setsid "$bin/deltamap" sim --world "$world" --links "$out" --seed "$seed" --truth "$out/truth.jsonl" 2>"$out/sim.log" &
simulator=$!  # of a session of its own: Ctrl-C ends the daemon first
trap 'kill $simulator 2>/dev/null || true' EXIT
for _ in $(seq 50); do [[ -e $out/robot && -e $out/laser ]] && break; sleep 0.1; done

# The page asks for a token where it may drive.
(umask 077; head -c 24 /dev/urandom | base64 | tr '+/' '-_' >"$out/token")

# The page draws into these files.
echo "bays:" >"$out/bays.yaml"
echo "zones:" >"$out/zones.yaml"

# A robot that nobody has switched on stands: here the one who called the demo does.
(for _ in $(seq 150); do "$bin/deltamap" ctl --socket "$out/ctl.sock" drive wander >/dev/null 2>&1 && break; sleep 0.2; done) &
echo "the robot drives ${seconds:+for $seconds s }in $world (seed $seed)$until; watch: $out" >&2
((page == 0)) || echo "open http://127.0.0.1:$page/?token=$(<"$out/token") in a browser" >&2
# Ended as systemd would: SIGTERM, and the map is saved.
"${pin[@]}" "${limit[@]}" "$bin/deltamapd" --config config/simulation.yaml \
  --set robot.port="$out/robot" --set laser.port="$out/laser" --set map.file="$out/m0.yaml" --set map.store="$out/store.sqlite" --set control.socket="$out/ctl.sock" --set dashboard.port="$page" --set dashboard.token_file="$out/token" \
  --set bays.file="$out/bays.yaml" --set zones.file="$out/zones.yaml" --set incidents.folder="$out/incidents" --set poses.socket="$out/poses.sock" \
  --set recording.file="$out/recording.pcapng" --set seed="$seed" --out "$out/run" &
daemon=$!
trap 'kill -TERM $daemon 2>/dev/null || true' INT TERM
wait "$daemon" || wait "$daemon"  # a signal ends the first one
trap - INT TERM
kill "$simulator" && wait "$simulator" || true
trap - EXIT

"$bin/deltamap" score --truth "$out/truth.jsonl" --world "$world" --trajectory "$out/run/trajectory.tum" \
  --start-map "$out/m0.yaml" --map "$out/run/map.yaml" --json >"$out/score.json"
"$bin/deltamap" score --truth "$out/truth.jsonl" --world "$world" --trajectory "$out/run/trajectory.tum" \
  --start-map "$out/m0.yaml" --map "$out/run/map.yaml"
"$bin/deltamap" map picture "$out/m0.yaml" "$out/before.png"
"$bin/deltamap" map picture "$out/run/map.yaml" "$out/after.png" --before "$out/m0.yaml" --trajectory "$out/run/trajectory.tum"
"$bin/deltamap" map film "$out/store.sqlite" "$out/film.png" --trajectory "$out/run/trajectory.tum"
echo "pictures: $out/before.png, $out/after.png and, animated, $out/film.png"
