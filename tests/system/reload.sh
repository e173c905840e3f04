#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A running daemon reads its settings again, by `ctl reload` and by SIGHUP without a terminal: it takes what can change,
# names what needs a restart, and keeps all as it was where the file has mistakes. usage: reload.sh FOLDER-OF-PROGRAMS
set -euo pipefail
bin=$1
source "$(dirname "${BASH_SOURCE[0]}")/two_ports.sh"
write_first_map
# write_settings [OPTION...]: a settings file that names the map
write_settings() { "$bin/deltamapd" --config config/simulation.yaml --set map.file="$out/m0.yaml" "$@" --print-config >"$out/robot.yaml"; }
write_settings

setsid "$bin/deltamapd" --config "$out/robot.yaml" --set robot.port="$out/no_robot" --set laser.port="$out/no_laser" --set map.store= --set recording.file= \
  --set control.socket="$out/ctl.sock" 2>"$out/daemon.log" &
daemon=$!
await "the daemon does not answer" does status

# reloads CODE WORDS: by ctl
reloads() {
  local code=0
  ctl reload >"$out/reload.log" 2>&1 || code=$?
  [[ $code == "$1" ]] || fail "exit code $code in place of $1"
  grep -qF -- "$2" "$out/reload.log" || fail "no line with '$2'"
}
logs() { await "the log has no '$1'" grep -qF -- "$1" "$out/daemon.log"; }
key() { "$bin/deltamapd" --config "$out/robot.yaml" --print-config | grep -c "$1" >/dev/null || fail "the file is not as it should be"; }

reloads 0 "the settings are as they were"
write_settings --set recording.max_gigabytes=2
reloads 0 "needs a restart: recording.max_gigabytes: 2 (in force 8)"
logs "reload: needs a restart: recording.max_gigabytes"

write_settings --set navigation.safety.margin_m=0.21
key 'margin_m: 0.21'
kill -s HUP "$daemon"
logs "reload: taken: navigation.safety.margin_m: 0.21 (before "
reloads 0 "the settings are as they were"

printf 'seed: x\nlazer: {port: a}\nnavigation: {safety: {margin_m: 0.5}}\n' >"$out/robot.yaml"
reloads 1 "the settings stay as they are: the file cannot be taken"
grep -qF "robot.yaml:1:7: seed: needs a whole number" "$out/reload.log" || fail "the first mistake is not told"
grep -qF "robot.yaml:2:1: lazer: unknown section (nearest section laser)" "$out/reload.log" || fail "nor the second"
kill -s HUP "$daemon"
logs "warning reload: $out/robot.yaml:2:1: lazer: unknown section"
printf 'map: {file: %s}\n' "$out/none.yaml" >"$out/robot.yaml"
reloads 1 "none.yaml: No such file or directory"
: >"$out/robot.yaml"
reloads 1 "'map.file' names no map"
write_settings --set localization.initial_pose='[1000,1000,0]'
reloads 1 "'localization.initial_pose': 1000,1000 lies outside the map"
write_settings --set map.newest="$out/newest.txt"
reloads 1 "'map.newest' must name a description, NAME.yaml"
write_settings --set map.file="$out/m0.pgm"
reloads 1 "m0.pgm"
rm "$out/robot.yaml"
reloads 1 "cannot read the settings: No such file or directory"
mkfifo "$out/robot.yaml"
reloads 1 "is no plain file"
rm "$out/robot.yaml"

write_settings --set navigation.safety.margin_m=0.21
reloads 0 "the settings are as they were"
kill "$daemon"
wait "$daemon" || fail "the daemon did not end well"
daemon=
echo "reload: 12 by ctl, 2 by SIGHUP"
