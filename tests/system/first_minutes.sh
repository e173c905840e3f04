#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# README's lines for a robot, as they are written there, on a machine without devices: as this user, and where that is
# root also as one who may write nowhere else. usage: first_minutes.sh FOLDER-OF-PROGRAMS
set -euo pipefail
bin=$1
source "$(dirname "${BASH_SOURCE[0]}")/two_ports.sh"
fail() { echo "first_minutes: $1" >&2; cat "$place"/*.log >&2; exit 1; }

# block N: the Nth block of commands under "On a robot", without the build
block() {
  awk -v wanted="$1" '/^## /{ours = /^## On a robot/} ours && /^```/{n += !inside; inside = !inside; next}
                      ours && inside && n == wanted' README.md | grep -v '^\./dev build'
}

# play NAME COMMAND...: everything in a folder of its own, through COMMAND
play() {
  place=$out/$1
  shift
  mkdir -p "$place/build/release/bin"
  cp "$bin/deltamap" "$bin/deltamapd" "$place/build/release/bin"
  cp -r config "$place"
  { block 1 | sed 's|^build/release/bin/deltamapd|exec &|'; } >"$place/first"
  block 2 >"$place/second"
  grep -q 'exec .*deltamapd --config config/pioneer.yaml' "$place/first" || fail "README has no line for the daemon"
  grep -q 'ctl .*status' "$place/second" || fail "README has no line for ctl"
  [[ $# == 0 ]] || chown -R 65534:65534 "$place"
  cd "$place"
  "$@" bash -eu first >first.log 2>&1 &
  daemon=$!
  answers() { "$@" bash -eu second >second.log 2>&1; }
  await "no socket" test -S run/ctl.sock
  await "ctl has failed" answers "$@"
  grep -q 'no scan yet' second.log || fail "no status"
  kill -TERM "$daemon"
  wait "$daemon" || fail "the daemon did not end with 0"
  daemon=
  for line in 'deltamapd 0.*commit' 'settings: file=config/pioneer.yaml' 'map: file=run/hall.yaml size=' 'store: file=run/site.sqlite revision=0' \
    'ports: robot=/dev/ttyUSB0 laser=/dev/ttyUSB1' 'drive: mode=off'; do
    grep -q "$line" first.log || fail "the log lacks: $line"
  done
  grep -q '"commit"' run/report.json || fail "no report"
  local check
  check="$(sed -n 's/^exec //;/deltamapd/,$p' first | tr -d '\\\n') --check-config"
  before=$(find . -path ./run/check.log -prune -o -type f -printf '%p %s %T@\n' | sort)
  "$@" bash -euc "$check" >check.log 2>&1 || fail "--check-config does not end with 0"
  grep -q '^warning  robot .*is missing' check.log || fail "--check-config does not look at the ports"
  [[ $(find . -name check.log -prune -o -type f -printf '%p %s %T@\n' | sort) == "$before" ]] || fail "--check-config has changed a file"
  cd - >/dev/null
}

[[ -e /dev/ttyUSB0 || -e /dev/ttyUSB1 ]] && { echo "first_minutes: devices are plugged in: not tried" >&2; exit 77; }
users=1
play here
if ((EUID == 0)); then
  chmod 755 "$out"
  play nobody setpriv --reuid=65534 --regid=65534 --clear-groups
  users=2
  # The delivered store, where this user may not make its folder: one line with the cure, exit code 2.
  if [[ ! -e /var/lib/deltamap ]]; then
    code=0
    (cd "$out/nobody" && setpriv --reuid=65534 --regid=65534 --clear-groups build/release/bin/deltamapd --config config/pioneer.yaml \
      --set map.file=run/hall.yaml >refused.log 2>&1) || code=$?
    [[ $code == 2 ]] || fail "a store that cannot be: exit code $code, not 2"
    [[ $(wc -l <"$out/nobody/refused.log") == 1 ]] || fail "a store that cannot be takes more than one line"
    grep -q "map.store.*sudo install -d.*--set map.store=FILE" "$out/nobody/refused.log" || fail "no cure is named"
  fi
fi
echo "figure users = $users"
