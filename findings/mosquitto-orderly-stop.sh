#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: a broker that is stopped in good order (systemctl restart) publishes no last wills, since no client went away; a
#   robot's retained ONLINE is there again after the restart.
# Seen: at SIGTERM mosquitto publishes the will of every client that is connected, to whoever listens, and keeps it: after
#   the restart the retained connection state of every robot is CONNECTION_BROKEN.
# Matters: an update of the broker makes a fleet manager count all robots as lost, and a robot that thinks it has told
#   ONLINE once and for all stays lost: it has to say ONLINE again after each connect, as VDA 5050 has it.
# Version: mosquitto 2.0.11 (2.0.11-1.2+deb12u2). Source: MQTT 3.1.1, section 3.1.2.5, lists failures of the network and of the
#   client and errors of protocol as reasons for a will, no end of the server; VDA 5050 2.1.0, section 6.14, has it sent
#   only when a connection is unexpectedly interrupted; mosquitto(8) does not speak of wills.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

debian_programs mosquitto=2.0.11-1.2+deb12u2 mosquitto-clients=2.0.11-1.2+deb12u2 libmosquitto1=2.0.11-1.2+deb12u2
export LD_LIBRARY_PATH=$libraries PATH=$root/usr/bin:$root/usr/sbin:$PATH
server=(-h 127.0.0.1 -p $((20000 + RANDOM % 10000)))
topic=uagv/v2/example/robot/connection
cat > broker.conf << CONF
listener ${server[3]} 127.0.0.1
allow_anonymous true
persistence true
persistence_location $work/
user $(id -un)
CONF
start_broker() {
  mosquitto -c broker.conf 2> broker.log &
  broker=$!
  for _ in {1..100}; do mosquitto_pub "${server[@]}" -t ready -n 2> /dev/null && return; sleep 0.1; done
}
heard() { for _ in {1..100}; do grep -q "$1" fleet.log && return; sleep 0.1; done; }

start_broker
mosquitto_pub "${server[@]}" -t $topic -r -q 1 -m ONLINE
mosquitto_sub "${server[@]}" -i robot -t orders --will-topic $topic --will-payload CONNECTION_BROKEN --will-retain --will-qos 1 &
robot=$!
stdbuf -oL mosquitto_sub "${server[@]}" -i fleet -t $topic > fleet.log &
fleet=$!
heard ONLINE
sleep 0.5
kill -TERM $broker
wait $broker || true
heard BROKEN
kill $robot $fleet
wait $robot $fleet 2> /dev/null || true
start_broker
stated 'fleet heard' 'ONLINE CONNECTION_BROKEN' "$(paste -sd ' ' fleet.log)"
stated 'retained after the restart' CONNECTION_BROKEN "$(mosquitto_sub "${server[@]}" -t $topic -C 1 -W 5)"
