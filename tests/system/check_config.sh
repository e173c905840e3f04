#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# What --check-config says of an output is what a start then does: for each case both are run, and must be of one mind:
# ok, warning (it starts, and says what is degraded) or error (it does not start). Needs root for other users and for a
# read-only file system; what cannot be had is left out and counted. usage: check_config.sh FOLDER-OF-PROGRAMS
set -euo pipefail
bin=$1
source "$(dirname "${BASH_SOURCE[0]}")/two_ports.sh"
write_first_map
chmod 755 "$out"
disk=$out/disk
holder=
clean_up() {
  [[ -z $holder ]] || kill -9 "$holder" 2>/dev/null || true
  umount "$disk" 2>/dev/null || true
}

as_other=()
((EUID != 0)) || as_other=(setpriv --reuid=65534 --regid=65534 --clear-groups)
plain=("${on_the_world[@]}" --set robot.port="$out/no_robot" --set laser.port="$out/no_laser"
  --set map.store= --set recording.file= --set control.socket= --initial-pose 1,2,0)
# A sound store with its first map, to copy.
"$bin/deltamapd" "${plain[@]}" --set map.store="$out/sound.sqlite" 2>"$out/sound.log" &
daemon=$!
await "no daemon to begin with" said ' robot: .*no_robot' "$out/sound.log"
kill "$daemon" && wait "$daemon" || fail "the first daemon did not end well"
daemon=
[[ -s $out/sound.sqlite && ! -e $out/sound.sqlite-wal ]] || fail "no store to begin with"

# checked OPTION...: the verdict of --check-config; absent devices are no matter here
checked() {
  local code=0
  timeout -s KILL 120 "$@" --check-config >"$out/check.log" 2>&1 || code=$?
  [[ $code == 0 || $code == 2 ]] || fail "--check-config ends with $code"
  ((code == 0)) || { echo error; return; }
  grep '^warning' "$out/check.log" | grep -vq '^warning  \(robot\|laser\) ' && echo warning || echo ok
}
# started OPTION...: the verdict of a start
started() {
  : >"$out/start.log"  # the lines of the start before must not be taken for this one's
  "$@" 2>"$out/start.log" &
  daemon=$!
  # The pipeline is up where it looks for the devices.
  until said ' robot: .*no_robot' "$out/start.log" || has_ended "$daemon"; do sleep 0.05; done
  local code=0
  kill -TERM "$daemon" 2>/dev/null || true
  wait "$daemon" || code=$?
  daemon=
  [[ $code -le 2 ]] || fail "a start ends with $code"
  ((code == 0)) || { echo error; return; }
  grep '^[0-9:.]* warning ' "$out/start.log" | grep -vq ' warning \(robot\|laser\): ' && echo warning || echo ok
}

# files: everything in the place with size, mode and time; what a daemon that is at work there writes is its own
files() { [[ -n $holder ]] || find "$place" -printf '%p %s %m %T@\n' | sort; }

cases=0
# agree VERDICT WHAT [RUN-AS...] -- OPTION...: in the folder $place, which the caller has made ready
agree() {
  local wanted=$1 what=$2 as=() check start before
  shift 2
  while [[ $1 != -- ]]; do as+=("$1"); shift; done
  shift
  before=$(files)
  checked "${as[@]}" "$bin/deltamapd" "${plain[@]}" "$@" >"$out/checked"
  [[ $(files) == "$before" ]] || fail "$what: --check-config has changed something"
  started "${as[@]}" "$bin/deltamapd" "${plain[@]}" "$@" >"$out/started"
  check=$(<"$out/checked") start=$(<"$out/started")
  [[ $check == "$start" ]] || fail "$what: --check-config says $check, a start $start"
  [[ $check == "$wanted" ]] || fail "$what: $check in place of $wanted"
  cases=$((cases + 1))
}
# new_place: an empty folder that everybody may write to
new_place() {
  place=$(mktemp -d "$out/place-XXXX")
  chmod 777 "$place"
}

new_place
agree ok "nothing is there yet" -- --set map.store="$place/state/store.sqlite" --set recording.file="$place/made/bytes.pcapng" --out "$place/run"
new_place
cp "$out/sound.sqlite" "$place/store.sqlite"
echo older >"$place/bytes.pcapng"
agree ok "all is there" -- --set map.store="$place/store.sqlite" --set recording.file="$place/bytes.pcapng" --out "$place"
new_place
head -c 20000 /dev/urandom >"$place/store.sqlite"
agree warning "a damaged store" -- --set map.store="$place/store.sqlite"
new_place
echo >"$place/ctl.sock"
agree warning "a file in place of the socket" -- --set control.socket="$place/ctl.sock"
agree warning "a file in place of the poses' socket" -- --set poses.socket="$place/ctl.sock"
new_place
echo >"$place/file"
agree error "a file in place of the store's folder" -- --set map.store="$place/file/store.sqlite"
agree error "a file in place of the recording's folder" -- --set recording.file="$place/file/bytes.pcapng"
agree error "a file in place of --out" -- --out "$place/file/run"
agree error "a folder in place of the store" -- --set map.store="$place"
agree error "a folder in place of the recording" -- --set recording.file="$place"
cp "$out"/m0.* "$place"
mv "$place/m0.yaml" "$place/map.yaml"
agree error "--out onto the map" -- --set map.file="$place/map.yaml" --out "$place"

new_place
"$bin/deltamapd" "${plain[@]}" --set map.store="$place/store.sqlite" --set recording.file="$place/bytes.pcapng" --out "$place/run" 2>"$out/holder.log" &
holder=$!
await "the daemon that holds all is not up" said ' robot: .*no_robot' "$out/holder.log"
agree error "a store in use" -- --set map.store="$place/store.sqlite"
agree error "a recording in use" -- --set recording.file="$place/bytes.pcapng"
agree error "an --out in use" -- --out "$place/run"
kill -9 "$holder"
wait "$holder" 2>/dev/null || true
holder=
[[ -e $place/store.sqlite.lock ]] || fail "a killed daemon leaves its lock file behind: this test expects so"
agree ok "what a killed daemon has left" -- --set map.store="$place/store.sqlite" --set recording.file="$place/bytes.pcapng" --out "$place/run"

left_out=
if [[ ${#as_other[@]} -gt 0 ]]; then
  new_place
  cp "$out/sound.sqlite" "$place/store.sqlite"
  chmod 444 "$place/store.sqlite"
  agree warning "a store that may only be read" "${as_other[@]}" -- --set map.store="$place/store.sqlite"
  new_place
  cp "$out/sound.sqlite" "$place/store.sqlite"
  chmod 600 "$place/store.sqlite"
  agree error "a store that may not be read" "${as_other[@]}" -- --set map.store="$place/store.sqlite"
  new_place
  cp "$out/sound.sqlite" "$place/store.sqlite"
  chmod 666 "$place/store.sqlite"
  chmod 755 "$place"
  agree error "a store whose folder is forbidden" "${as_other[@]}" -- --set map.store="$place/store.sqlite"
  agree error "a new store in a forbidden folder" "${as_other[@]}" -- --set map.store="$place/new.sqlite"
  agree error "a recording in a forbidden folder" "${as_other[@]}" -- --set recording.file="$place/bytes.pcapng"
  agree error "a recording whose folder cannot be made" "${as_other[@]}" -- --set recording.file="$place/new/bytes.pcapng"
  agree error "an --out that is forbidden" "${as_other[@]}" -- --out "$place"
  agree error "an --out that cannot be made" "${as_other[@]}" -- --out "$place/new"
  agree warning "a socket in a forbidden folder" "${as_other[@]}" -- --set control.socket="$place/ctl.sock"
  echo 'deltamapd (pid 1)' >"$place/store.sqlite.lock"
  chmod 444 "$place/store.sqlite.lock"
  agree warning "a store in a forbidden folder that can be locked" "${as_other[@]}" -- --set map.store="$place/store.sqlite"
  new_place
  echo >"$place/store.sqlite.lock"
  echo >"$place/bytes.pcapng.lock"
  echo >"$place/.lock"
  chmod 600 "$place"/*.lock "$place/.lock"
  agree error "a store whose lock is forbidden" "${as_other[@]}" -- --set map.store="$place/store.sqlite"
  agree error "a recording whose lock is forbidden" "${as_other[@]}" -- --set recording.file="$place/bytes.pcapng"
  agree error "an --out whose lock is forbidden" "${as_other[@]}" -- --out "$place"
  new_place
  echo older >"$place/bytes.pcapng"
  chmod 1777 "$place"
  agree error "another user's recording in a folder like /tmp" "${as_other[@]}" -- --set recording.file="$place/bytes.pcapng"
else
  left_out="other users"
fi

mkdir "$disk"
if mount -t tmpfs -o size=4m tmpfs "$disk" 2>/dev/null; then
  place=$disk
  mkdir "$disk/run"
  cp "$out/sound.sqlite" "$disk/store.sqlite"
  mount -o remount,ro "$disk"
  agree warning "a store on a read-only file system" -- --set map.store="$disk/store.sqlite"
  agree error "a new store on a read-only file system" -- --set map.store="$disk/new.sqlite"
  agree warning "a recording on a read-only file system" -- --set recording.file="$disk/bytes.pcapng"
  agree error "a recording in a new folder on a read-only file system" -- --set recording.file="$disk/new/bytes.pcapng"
  agree warning "an --out on a read-only file system" -- --out "$disk/run"
  agree error "a new --out on a read-only file system" -- --out "$disk/new"
else
  left_out+=" read-only file systems"
fi
echo "figure cases = $cases${left_out:+ (left out: $left_out)}"
