#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: vda-5050-lib publishes the connection topic with QoS 1, as VDA 5050 asks for, and a master of version 2.0.0 hears
#   a robot of 2.1.0: both speak under uagv/v2, where the topic carries the major version alone.
# Seen: everything goes out with QoS 0, connection states and the last will included. And a message whose version is not,
#   letter for letter, the client's own is dropped with a line on the console: the robot of 2.1.0 does not exist.
# Matters: a daemon that speaks VDA 5050 to a fleet manager built on this library needs its exact version string as a
#   setting, and cannot rely on ONLINE reaching the broker over a lossy radio.
# Version: vda-5050-lib 1.4.0, aedes 0.51.3 as broker, mqtt 5.10.1 (npm). Source: VDA5050_EN.md of 2.1.0, sections 6.2
#   ("connection" shall use QoS 1), 6.3 (topic with major version).
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

npm_packages vda-5050-lib@1.4.0 aedes@0.51.3 mqtt@5.10.1
cat > peer.js << 'JS'
const { AgvClient, MasterControlClient, Topic } = require('vda-5050-lib');
const broker = require('aedes')();
const mqtt = require('mqtt');

const state = {
  orderId: '', orderUpdateId: 0, lastNodeId: '', lastNodeSequenceId: 0, nodeStates: [], edgeStates: [], driving: false,
  actionStates: [], batteryState: { batteryCharge: 50, charging: false }, operatingMode: 'AUTOMATIC', errors: [],
  safetyState: { eStop: 'NONE', fieldViolation: false }, headerId: 0, timestamp: '2026-01-01T00:00:00.00Z',
  manufacturer: 'example', serialNumber: 'other',
};
const server = require('net').createServer(broker.handle);
server.listen(0, '127.0.0.1', async () => {
  const brokerUrl = `mqtt://127.0.0.1:${server.address().port}`;
  const options = { interfaceName: 'uagv', transport: { brokerUrl }, vdaVersion: '2.0.0' };
  const seen = [];
  broker.on('clientReady', (client) => client.will && seen.push(`will qos ${client.will.qos}`));
  broker.on('publish', (packet) => packet.topic.endsWith('/connection') &&
    seen.push(`${JSON.parse(packet.payload).connectionState} qos ${packet.qos} retain ${packet.retain}`));
  console.warn = console.error = (...words) => words.join(' ').includes('Version') && seen.push('dropped for its version');

  const robot = new AgvClient({ manufacturer: 'example', serialNumber: 'robot' }, options);
  await robot.start();
  const master = new MasterControlClient(options);
  await master.start();
  await master.subscribe(Topic.State, {}, (heard) => seen.push(`heard ${heard.version}`));
  const other = await mqtt.connectAsync(brokerUrl);
  for (const version of ['2.0.0', '2.1.0']) {
    await other.publishAsync('uagv/v2/example/other/state', JSON.stringify({ ...state, version }), { qos: 1 });
    await new Promise((done) => setTimeout(done, 500));
  }
  console.log(seen.join(', '));
  process.exit(0);
});
JS
stated seen 'will qos 0, ONLINE qos 0 retain true, heard 2.0.0, dropped for its version' "$(timeout 60 node peer.js)"
