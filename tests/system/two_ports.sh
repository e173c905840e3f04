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

# await WHAT COMMAND...: until the command succeeds. A busy machine is slow and has time, but not without the daemon.
patience_s=120
await() {
  local what=$1 give_up_at=$((SECONDS + patience_s))
  shift
  until "$@"; do
    ((SECONDS < give_up_at)) || fail "$what"
    [[ -z $daemon ]] || kill -0 "$daemon" 2>/dev/null || fail "$what: the daemon has ended"
    sleep 0.1
  done
}
# said WORDS LOG: the log has the words
said() { grep -q -- "$1" "$2" 2>/dev/null; }
has_ended() { ! kill -0 "$1" 2>/dev/null; }

write_first_map() { "$bin/deltamap" sim --world "$world" --write-map "$out/m0.yaml"; }

# simulate [OPTION...]: robot and laser behind $out/robot and $out/laser
simulate() {
  "$bin/deltamap" sim --world "$world" --links "$out" --seed 1 --truth "$out/truth.jsonl" "$@" 2>"$out/sim.log" &
  simulator=$!
  await "no simulator" test -e "$out/robot" -a -e "$out/laser"
}
# truth: the newest true times and poses of the robot
truth() { grep -o '"t_ns":[0-9]*,"pose":[^]]*]' "$out/truth.jsonl" | tail -n 200; }
# stands: it has not moved for a second and a half of the simulator's time
stands() { truth | awk -F '"t_ns":|,"pose":' '$3 != pose { pose = $3; since = $2 } END { exit !(NR > 0 && $2 - since > 1.5e9) }'; }
# moves: nor has it stood for half a second
moves() { truth | awk -F '"t_ns":|,"pose":' '$3 != pose { pose = $3; since = $2; ++poses } END { exit !(poses > 3 && $2 - since < 0.5e9) }'; }

# The options of a daemon on the map of the world and the ports $out/robot and $out/laser.
on_the_world=(--config config/simulation.yaml --set robot.port="$out/robot" --set laser.port="$out/laser" --set map.file="$out/m0.yaml")
ctl() { "$bin/deltamap" ctl --socket "$out/ctl.sock" "$@"; }
# does ORDER...: the daemon has done it. It refuses what has waited for a second: ask again.
does() { ctl "$@" >"$out/order.log" 2>&1; }
# tells WORDS: they stand in the status
tells() { [[ $(ctl status --json 2>/dev/null) == *"$1"* ]]; }
# number NAME: of the status; 0 where none is told
number() {
  local found
  found=$(ctl status --json 2>/dev/null | grep -o "\"$1\":[0-9]*" | head -n 1 | cut -d: -f2) || true
  echo "${found:-0}"
}
reached() { (($(number "$1") >= $2)); }
# localizes N: so many scans more than by now
localizes() {
  local from=0
  known() { from=$(number localized); ((from > 0)); }
  await "no scan is localized" known
  await "no $1 scans more are localized" reached localized $((from + $1))
}
# A machine that is busy reads the ports late, and a pose belongs to where the robot was when it was measured: at this pace
# seconds of it are centimetres.
slowly=(--set navigation.safety.max_speed_m_per_s=0.1 --set navigation.safety.max_turn_rate_deg_per_s=10)
