# SPDX-License-Identifier: Apache-2.0
# Sourced by the tests of this folder: the programs and a folder for a test, a simulated world behind two
# pseudo-terminals, the daemon. Whatever runs is ended and the folder removed with the test.
# usage, after `set -euo pipefail`: bin=FOLDER-OF-PROGRAMS; source "$(dirname "${BASH_SOURCE[0]}")/two_ports.sh"
bin=$(realpath "$bin")
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
out=$(mktemp -d)
world=config/scenarios/room.yaml
daemon= simulator=
test_name=$(basename "$0" .sh)

# clean_up: a test may say what else is to be undone before the folder goes
clean_up() { :; }
end_all() {
  for process in $daemon $simulator; do kill -9 "$process" 2>/dev/null || true; done
  wait 2>/dev/null || true
  clean_up
  rm -rf "$out"
}
trap end_all EXIT
fail() { echo "$test_name: $1" >&2; cat "$out"/*.log >&2 2>/dev/null || true; exit 1; }

write_first_map() { "$bin/deltamap" sim --world "$world" --write-map "$out/m0.yaml"; }

# simulate [OPTION...]: robot and laser behind $out/robot and $out/laser
simulate() {
  "$bin/deltamap" sim --world "$world" --links "$out" --seed 1 --truth "$out/truth.jsonl" "$@" 2>"$out/sim.log" &
  simulator=$!
  for _ in $(seq 100); do [[ -e $out/robot && -e $out/laser ]] && return; sleep 0.1; done
  fail "no simulator"
}

# The options of a daemon on the map of the world and the ports $out/robot and $out/laser.
on_the_world=(--config config/simulation.yaml --set robot.port="$out/robot" --set laser.port="$out/laser" --set map.file="$out/m0.yaml")
ctl() { "$bin/deltamap" ctl --socket "$out/ctl.sock" "$@"; }
