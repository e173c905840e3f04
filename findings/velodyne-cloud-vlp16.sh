#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: Foxglove's library for Velodyne packets, used as in its README, dates a packet by its microseconds since the hour, tells
#   when each point was measured in nanoseconds since the first packet, and lays each of the 24 firings of a VLP-16's packet where
#   the laser looked then.
# Seen: the microseconds are divided by a millionth: half past the hour is 1.8 * 10^15 s after it, 57 million years. The second's
#   points, sent 1.327 ms after the first's, are 0.55 s after them: what 32 bits hold of 10^12 times as much. And both firings of a
#   block lie at the block's own azimuth: at 600 revolutions a minute the second is 0.2 degrees behind, its last laser 0.325.
# Matters: whoever frees a cloud of the robot's motion by these times smears it; and each wall has a comb of 7 to 11 cm at 20 m,
#   twice that at 1200 a minute. The function that corrects the azimuth is there and is called: it decides on the cut to minAngle
#   and maxAngle alone. Give unpack() the receiver's stamps, and turn the points by their offset within the block.
# Version: @foxglove/velodyne-cloud 1.0.1 (npm). Source: VLP-16 User Manual (63-9243), time stamp in microseconds and "Precision
#   Azimuth Calculation"; GpsTimestampToTimestamp in RawPacket.ts, _unpackVLP16 in Transformer.ts.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

npm_packages @foxglove/velodyne-cloud@1.0.1
cat > turn.js << 'JS'
const { Calibration, Model, PointCloud, RawPacket, Transformer } = require('@foxglove/velodyne-cloud');

// A packet of a VLP-16 that turns by 0.4 degrees a block (600 a minute) and sees 10 m all round.
function packet(firstDeg, microseconds) {
  const data = Buffer.alloc(1206);
  for (let block = 0; block < 12; ++block) {
    const at = 100 * block;
    data.writeUInt16LE(0xeeff, at);
    data.writeUInt16LE(Math.round(100 * (firstDeg + 0.4 * block)), at + 2);
    for (let laser = 0; laser < 32; ++laser) data.writeUInt16LE(5000, at + 4 + 3 * laser);
  }
  data.writeUInt32LE(microseconds, 1200);
  data[1204] = 0x37;
  data[1205] = 0x22;
  return new RawPacket(new Uint8Array(data));
}

const hour = new Date(Date.UTC(2026, 10, 30, 12));
const first = packet(10, 1800000000);
const second = packet(14.8, 1800001327);
const stamp = first.timestamp();
const cloud = new PointCloud({ stamp, maxPoints: 2 * RawPacket.MAX_POINTS_PER_PACKET });
const transformer = new Transformer(new Calibration(Model.VLP16));
for (const each of [first, second]) transformer.unpack(each, stamp, undefined, cloud);
const delayS = (index) => (cloud.point(index).deltaNs * 1e-9).toFixed(6);
const azimuthDeg = (index) => ((Math.atan2(-cloud.point(index).y, cloud.point(index).x) * 180) / Math.PI).toFixed(2);
console.log(`${first.timestamp(hour) - hour / 1000}; ${delayS(0)} ${delayS(384)}; ${[0, 16, 31, 32].map(azimuthDeg).join(' ')}`);
JS
stated 'seconds after the hour; after the first packet; degrees of lasers 0, 16, 31, 32' \
  '1800000000000000; 0.000000 0.552698; 10.00 10.00 10.00 10.40' "$(timeout 60 node turn.js)"
