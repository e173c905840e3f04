#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# How long a failed daemon waits for its next start: longer with each failure, up to a minute; at once after an orderly
# end, and as after the first failure where the last run was a long one. Nothing sleeps here: `sleep` is a stand-in.
# usage: restart_delay.sh
set -euo pipefail
helper=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../../systemd/restart-delay")
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
fail() { echo "restart_delay: $1" >&2; exit 1; }

mkdir "$out/bin" "$out/run"
printf '#!/bin/sh\necho "$1" >%s/slept\n' "$out" >"$out/bin/sleep"
chmod +x "$out/bin/sleep"
export PATH=$out/bin:$PATH RUNTIME_DIRECTORY=$out/run

# delay_is SECONDS: what it waits before the next start
delay_is() {
  echo 0 >"$out/slept"
  "$helper" wait >"$out/told"
  [[ $(<"$out/slept") == "$1" ]] || fail "waits $(<"$out/slept") s in place of $1"
  [[ $1 == 0 ]] || grep -q "another $1 s" "$out/told" || fail "does not tell of $1 s: $(<"$out/told")"
}
ended() { SERVICE_RESULT=$1 "$helper" ended; }

delay_is 0
for delay_s in 0 2 4 8 16 32 60 60; do
  ended signal
  delay_is "$delay_s"
done
ended success
delay_is 0
for result in exit-code watchdog oom-kill; do ended "$result"; done
delay_is 4
echo $(($(cut -d. -f1 /proc/uptime) - 601)) >"$out/run/began"
ended core-dump
delay_is 0
ended signal
delay_is 2
for damaged in abc '3 4' x=5 08 12345678901234567890 '$(reboot)'; do
  echo "$damaged" >"$out/run/failures"
  echo "$damaged" >"$out/run/began"
  delay_is 0
  echo "$damaged" >"$out/run/began"
  ended signal
  ended signal
  delay_is 2
done
"$helper" 2>"$out/told" && fail "no usage" || [[ $? == 2 ]] || fail "exit code"
echo "restart_delay: the delays are right"
