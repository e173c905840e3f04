#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# How a start ends that cannot be: exit code 2 and one line where only a person can mend it, 1 where another daemon is at
# work; a daemon that was killed is in nobody's way; a store that is no good does not keep the daemon from its work.
# usage: start.sh FOLDER-OF-PROGRAMS
set -euo pipefail
bin=$1
source "$(dirname "${BASH_SOURCE[0]}")/two_ports.sh"
write_first_map
plain=("${on_the_world[@]}" --set robot.port="$out/no_robot" --set laser.port="$out/no_laser"
  --set map.store= --set recording.file= --set control.socket=)
# Root may all: what is forbidden is tried as another user.
as_other=()
((EUID != 0)) || as_other=(setpriv --reuid=65534 --regid=65534 --clear-groups)
chmod 755 "$out"
# expect CODE WORDS OPTION...: it ends so, with one line that has the words
expect() {
  local code=0 wanted=$1 words=$2
  shift 2
  timeout -s KILL 120 "${as[@]}" "$bin/deltamapd" "${plain[@]}" "$@" 2>"$out/daemon.log" || code=$?
  [[ $code == "$wanted" ]] || fail "exit code $code in place of $wanted: $*"
  grep '^deltamapd: ' "$out/daemon.log" | grep -q -- "$words" || fail "no line with '$words': $*"
}

as=()
echo 'image: none.pgm' >"$out/bad.yaml"
echo >"$out/file"
expect 2 "map.file" --set map.file=
expect 2 "none.yaml: No such file" --set map.file="$out/none.yaml"
expect 2 "bad.yaml: key 'resolution' is missing" --set map.file="$out/bad.yaml"
expect 2 "is no folder" --out "$out/file/run"
expect 2 "is no folder" --set map.store="$out/file/store.sqlite"
expect 2 "is a directory" --set map.store="$out"
mkfifo "$out/pipe"
expect 2 "pipe: is no plain file" --set map.store="$out/pipe"
expect 2 "is no folder" --set recording.file="$out/file/bytes.pcapng"
expect 2 "map.fiel" --set map.fiel=x
expect 2 "map.store: must not be the same file as 'map.file'" --set map.store="$out/m0.yaml"
expect 2 "recording.file: must not be the same file as the image of 'map.file'" --set recording.file="$out/m0.pgm"
[[ -s $out/m0.yaml && -s $out/m0.pgm ]] || fail "the first map was displaced"
expect 2 "m0.pgm: is the picture of a map; give its description (YAML), $out/m0.yaml" --set map.file="$out/m0.pgm"

as=("${as_other[@]}")
mkdir "$out/forbidden" "$out/mine"
cp "$out"/m0.* "$out/forbidden"
chmod 000 "$out/forbidden"
chmod 555 "$out/mine"
expect 2 "forbidden/m0.yaml: Permission denied" --set map.file="$out/forbidden/m0.yaml"
expect 2 "forbidden/run: cannot be made: $out/forbidden cannot be written to (Permission denied)" --out "$out/forbidden/run"
expect 2 "'map.store': $out/mine cannot be written to (Permission denied)" --set map.store="$out/mine/new/store.sqlite"
expect 2 "give this user the folder (sudo install -d -o [a-zA-Z]* $out/mine/new) or" --set map.store="$out/mine/new/store.sqlite"
expect 2 "give this user a folder of its own (sudo install -d -o [a-zA-Z]* FOLDER) and" --set map.store="$out/mine/store.sqlite"
expect 2 "forbidden/bytes.pcapng: cannot be looked at: Permission denied" --set recording.file="$out/forbidden/bytes.pcapng"
expect 2 "bytes.pcapng: cannot be written: $out/mine cannot be written to (Permission denied)" --set recording.file="$out/mine/new/bytes.pcapng"
as=()
chmod 755 "$out/forbidden" "$out/mine"

mkdir "$out/run"
"$bin/deltamapd" "${plain[@]}" --set map.store="$out/store.sqlite" --set recording.file="$out/bytes.pcapng" --set incidents.folder="$out/incidents" --out "$out/run" 2>"$out/first.log" &
daemon=$!
await "the first daemon is not up" said ' robot: .*no_robot' "$out/first.log"
holder="is in use by deltamapd (pid "
size=$(stat -c %i "$out/bytes.pcapng")
expect 1 "run: $holder" --out "$out/run"
expect 1 "store.sqlite: $holder" --set map.store="$out/store.sqlite"
expect 1 "bytes.pcapng: $holder" --set recording.file="$out/bytes.pcapng"
expect 1 "incidents: $holder" --set incidents.folder="$out/incidents" --set map.store="$out/another.sqlite"
[[ ! -e $out/another.sqlite ]] || fail "a daemon that was refused has left a store behind"
[[ $(stat -c %i "$out/bytes.pcapng") == "$size" && ! -e $out/bytes.previous.pcapng ]] || fail "the recording was touched"
"$bin/deltamap" map history "$out/store.sqlite" list >/dev/null || fail "a store in use cannot be read"
code=0
"$bin/deltamap" map history "$out/store.sqlite" rollback 0 2>"$out/tool.log" || code=$?
[[ $code == 1 ]] && grep -q "$holder" "$out/tool.log" || fail "rollback of a store in use: exit code $code"

kill -9 "$daemon"
wait "$daemon" 2>/dev/null || true
[[ -e $out/run/.lock ]] || fail "a killed daemon leaves its lock file behind: this test expects so"
rm -f "$out"/store.sqlite-*  # its log holds all of it
head -c 20000 /dev/urandom >"$out/store.sqlite"
"$bin/deltamapd" "${plain[@]}" --set map.store="$out/store.sqlite" --set recording.file="$out/bytes.pcapng" --out "$out/run" 2>"$out/second.log" &
daemon=$!
await "the second daemon is not up" said ' robot: .*no_robot' "$out/second.log"
kill "$daemon" || fail "the second daemon has ended"
wait "$daemon" || fail "the second daemon did not end well"
daemon=
grep -q "warning map store set aside as $out/store.sqlite.set-aside-1: " "$out/second.log" || fail "no warning"
[[ $(stat -c %s "$out/store.sqlite.set-aside-1") == 20000 ]] || fail "the damaged store was not kept"
[[ ! -e $out/run/.lock && ! -e $out/store.sqlite.lock && ! -e $out/bytes.pcapng.lock ]] || fail "locks are left behind"
echo "start: 18 mistakes end with exit code 2, 5 conflicts with 1"
