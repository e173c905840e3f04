#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: a publish() that returns "not connected" has not taken the message. One of QoS 0 is lost where there is no line.
# Seen: paho for Python and libmosquitto keep messages of QoS 1 and 2 that they have refused with code 4 (no connection), and
#   send them once they are connected; paho's is_published() raises "publish failed" for them. What they refuse with QoS 0
#   is lost. MQTT.js has no word for it: there QoS 0 is kept, too, and its callback tells success when it has left.
# Matters: a dispatcher that tries again after the error sends its order twice, and the robot gets one that was taken for
#   lost, however old it is by then. Only an order's own id and age help.
# Version: paho-mqtt 1.6.1 (1.6.1-1), libmosquitto 2.0.11 (2.0.11-1.2+deb12u2), MQTT.js 5.16.0 (npm). Source: paho's README
#   and libmosquitto's mosquitto.h call code 4 "the client is not currently connected", and say nothing of what is kept;
#   MQTT.js' README has queueQoSZero true.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

npm_packages mqtt@5.16.0
debian_programs mosquitto=2.0.11-1.2+deb12u2 mosquitto-clients=2.0.11-1.2+deb12u2 libmosquitto1=2.0.11-1.2+deb12u2 \
  python3-paho-mqtt=1.6.1-1
debian_files libmosquitto-dev=2.0.11-1.2+deb12u2
port=$((20000 + RANDOM % 10000))
cat > refused.py << 'PY'
import os
import sys
import time

import paho.mqtt.client as mqtt

client = mqtt.Client("paho")
told = []
for qos in (0, 1, 2):
    order = client.publish(f"paho/{qos}", "drive", qos, retain=True)
    try:
        raised = "published" if order.is_published() else "waits"
    except RuntimeError:
        raised = "raises"
    told.append(f"{order.rc} {raised}")
print("paho", *told, sep=", ", flush=True)
while not os.path.exists("up"):
    time.sleep(0.1)
client.connect("127.0.0.1", int(sys.argv[1]))
client.loop_forever()
PY
cat > refused.cpp << 'CPP'
#include <mosquitto.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

int main(int, char** arguments) {
  mosquitto_lib_init();
  mosquitto* client = mosquitto_new("c", true, nullptr);
  std::printf("libmosquitto");
  for (int qos = 0; qos <= 2; ++qos) {
    const char topic[] = {'c', '/', static_cast<char>('0' + qos), 0};
    std::printf(", %d", mosquitto_publish(client, nullptr, topic, 5, "drive", qos, true));
  }
  std::puts("");
  std::fflush(stdout);
  while (access("up", F_OK) != 0) usleep(100000);
  mosquitto_connect(client, "127.0.0.1", std::atoi(arguments[1]), 60);
  mosquitto_loop_forever(client, -1, 1);
}
CPP
compiled refused.cpp -l:libmosquitto.so.1
cat > refused.mjs << 'JS'
import mqtt from 'mqtt';

const client = mqtt.connect(`mqtt://127.0.0.1:${process.argv[2]}`, { clientId: 'js', reconnectPeriod: 300 });
client.on('error', () => {});
let told = 0;
for (const qos of [0, 1, 2]) {
  client.publish(`js/${qos}`, 'drive', { qos, retain: true }, (error) => {
    if (!error && ++told === 3) console.log('MQTT.js, three without an error');
  });
}
JS
export LD_LIBRARY_PATH=$libraries PATH=$root/usr/bin:$root/usr/sbin:$PATH
PYTHONPATH=$root/usr/lib/python3/dist-packages timeout 60 /usr/bin/python3 refused.py $port > paho.log &
timeout 60 ./run $port > c.log &
LD_LIBRARY_PATH= timeout 60 node refused.mjs $port > js.log &
sleep 2  # all have been told
printf '%s\n' "listener $port 127.0.0.1" 'allow_anonymous true' "user $(id -un)" > broker.conf
mosquitto -c broker.conf 2> broker.log &
for _ in {1..100}; do mosquitto_pub -h 127.0.0.1 -p $port -t ready -n 2> /dev/null && break; sleep 0.1; done
stdbuf -oL mosquitto_sub -h 127.0.0.1 -p $port -t '+/+' -F %t -W 6 > heard.log &
listener=$!
sleep 0.5
touch up
wait "$listener" || true
stated 'told' 'paho, 4 raises, 4 raises, 4 raises|libmosquitto, 4, 4, 4|MQTT.js, three without an error' \
  "$(cat paho.log c.log js.log | paste -sd '|')"
stated 'arrived' 'c/1,c/2,js/0,js/1,js/2,paho/1,paho/2' "$(sort -u heard.log | paste -sd ,)"
stated 'retained' 'js/0,js/1,js/2,paho/1,paho/2' \
  "$({ mosquitto_sub -h 127.0.0.1 -p $port -t '+/+' -F %t -W 1 2> /dev/null || true; } | sort | paste -sd ,)"
