#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: a message of QoS 1 that the broker's access list refuses is not acknowledged, or the connection is closed, and a
#   client whose last will lies on such a topic is not let in.
# Seen: with MQTT 3.1.1 the PUBACK comes as for a message that was taken, and the message is gone; the will is accepted
#   (CONNACK 0) and never published. With MQTT 5 the PUBACK says 135, not authorized.
# Matters: a robot that deletes from its own queue what was acknowledged loses every state and every CONNECTION_BROKEN to
#   one misspelt line of the access list, while all its counters say "delivered". Use version 5, or ask for an echo.
# Version: mosquitto 2.0.11 (2.0.11-1.2+deb12u2). Source: MQTT 3.1.1 section 3.3.5: a server that refuses a publish must
#   either acknowledge it or close the connection; mosquitto.conf(5), acl_file, does not say which it does.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs mosquitto=2.0.11-1.2+deb12u2 mosquitto-clients=2.0.11-1.2+deb12u2 libmosquitto1=2.0.11-1.2+deb12u2
export LD_LIBRARY_PATH=$libraries PATH=$root/usr/bin:$root/usr/sbin:$PATH
server=(-h 127.0.0.1 -p $((20000 + RANDOM % 10000)))
printf 'topic read #\ntopic write open/#\n' > access
printf '%s\n' "listener ${server[3]} 127.0.0.1" 'allow_anonymous true' "acl_file $work/access" "user $(id -un)" > broker.conf
mosquitto -c broker.conf 2> broker.log &
for _ in {1..100}; do mosquitto_pub "${server[@]}" -t ready -n 2> /dev/null && break; sleep 0.1; done

stdbuf -oL mosquitto_sub "${server[@]}" -t 'open/#' -t 'closed/#' > heard.log &
touch robot.log
stdbuf -oL mosquitto_sub "${server[@]}" -d -i robot -t orders --will-topic closed/will --will-payload broken > robot.log &
robots=($!)
mosquitto_sub "${server[@]}" -i other -t orders --will-topic open/will --will-payload broken &
robots+=($!)
for _ in {1..100}; do grep -q SUBACK robot.log && break; sleep 0.1; done
sleep 0.5
acknowledged() {  # VERSION TOPIC: the reason code of the PUBACK
  mosquitto_pub "${server[@]}" -d -V "$1" -q 1 -t "$2" -m "$2 $1" 2>&1 | sed -nE 's/.*received PUBACK \(Mid: 1, RC:([0-9]+)\)/\1/p'
}
stated 'CONNACK for a will on closed' 'CONNACK (0)' "$(grep -o 'CONNACK (.)' robot.log)"
stated '3.1.1, PUBACK for open and closed' '0 0' "$(acknowledged mqttv311 open/a) $(acknowledged mqttv311 closed/a)"
stated '5, PUBACK for closed' 135 "$(acknowledged mqttv5 closed/a)"
kill -KILL "${robots[@]}"
wait "${robots[@]}" 2> /dev/null || true
sleep 1
stated 'what a listener heard, both robots killed' 'open/a mqttv311,broken' "$(paste -sd , heard.log)"
