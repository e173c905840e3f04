#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: where the queue of a robot that is away is full, the broker drops the oldest message for the newest, or refuses the
#   publisher's.
# Seen: it keeps the oldest and drops all that come later. The publisher's PUBACK is that of a message that was taken, also
#   by version 5, which has a code for a quota; the broker's log alone tells it, once.
# Matters: the robot that comes back carries out the first orders of its absence, and never hears of the cancellation or of
#   where it is wanted now. Give orders an expiry, and keep the state that counts in one retained message.
# Version: mosquitto 2.0.11 (2.0.11-1.2+deb12u2). Source: mosquitto.conf(5), max_queued_messages (1000 as delivered): "the
#   maximum number … to hold in the queue"; MQTT 5 section 4.6 wants order, and reason code 0x97 is "Quota exceeded".
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs mosquitto=2.0.11-1.2+deb12u2 mosquitto-clients=2.0.11-1.2+deb12u2 libmosquitto1=2.0.11-1.2+deb12u2
export LD_LIBRARY_PATH=$libraries PATH=$root/usr/bin:$root/usr/sbin:$PATH
server=(-h 127.0.0.1 -p $((20000 + RANDOM % 10000)))
robot=("${server[@]}" -i robot -c -q 1 -t orders)
printf '%s\n' "listener ${server[3]} 127.0.0.1" 'allow_anonymous true' "user $(id -un)" 'max_queued_messages 5' > broker.conf
mosquitto -c broker.conf 2> broker.log &
for _ in {1..100}; do mosquitto_pub "${server[@]}" -t ready -n 2> /dev/null && break; sleep 0.1; done

mosquitto_sub "${robot[@]}" -E
for order in {1..12}; do
  version=$((order > 10 ? 5 : 311))
  mosquitto_pub "${server[@]}" -d -V "$version" -q 1 -t orders -m "$order" | sed -nE 's/.*PUBACK \(Mid: 1, RC:([0-9]+)\)/\1/p' >> told
done
stated 'PUBACK of 12 orders' '0 0 0 0 0 0 0 0 0 0 0 0' "$(paste -sd ' ' told)"
stated 'the robot hears' '1 2 3 4 5' "$({ mosquitto_sub "${robot[@]}" -W 2 2> /dev/null || true; } | paste -sd ' ')"
stated 'the log tells' 1 "$(grep -c 'Outgoing messages are being dropped for client robot' broker.log)"
