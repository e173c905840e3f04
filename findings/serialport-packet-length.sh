#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: serialport's packet-length parser, set to a laser's frame (02, address, two bytes of length, data, two bytes of CRC), gives
#   whole frames or none: what is longer than it may be is dropped, or told of as an error.
# Seen: of a frame whose length is more than maxLen, 255 by default, the first four bytes come out as a packet, and its data is then searched
#   for beginnings: after one scan of 732 bytes with two values of 02 in it there are three packets, none of them a frame, and
#   two replies that followed are gone, in the last. No error is raised. A single 02 of noise ahead of a frame has the same end.
# Matters: a scan of an LMS200 has 372 bytes in steps of a degree, 732 in half degrees: with a frame's options alone the replies to
#   commands come through and scans do not, and packets of other lengths look like a bad line. Set maxLen, and check each
#   packet's length and CRC.
# Version: @serialport/parser-packet-length 13.0.0 (npm). Source: its index.d.ts: "decodes packets with a delimiter and length of payload
#   specified within the data stream", maxLen "max packet length".
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

npm_packages @serialport/parser-packet-length@13.0.0
cat > frames.cjs << 'JS'
const { PacketLengthParser } = require('@serialport/parser-packet-length');

function frame(length, values = {}) {
  const bytes = Buffer.alloc(length + 6);
  bytes.set([0x02, 0x80]);
  bytes.writeUInt16LE(length, 2);
  bytes[4] = 0xb0;
  for (const [at, value] of Object.entries(values)) bytes[at] = value;
  return bytes;
}

async function packets(options, ...chunks) {
  const parser = new PacketLengthParser({ delimiter: 0x02, lengthOffset: 2, lengthBytes: 2, packetOverhead: 6, ...options });
  const lengths = [];
  parser.on('data', (packet) => lengths.push(packet.length));
  for (const chunk of chunks) parser.write(chunk);
  parser.end();
  await new Promise((resolve) => parser.on('end', resolve));
  return lengths.join(' ');
}

const reply = frame(20), scan = frame(726);
const scanOfTwos = frame(726, { 100: 0x02, 102: 0xff, 103: 0x01, 728: 0x02, 730: 0x40, 731: 0x00 });
(async () => {
  console.log(await packets({}, reply, reply));
  console.log(await packets({}, scan, reply));
  console.log(await packets({}, scanOfTwos, reply, reply));
  console.log(await packets({ maxLen: 1000 }, scanOfTwos, reply));
  console.log(await packets({ maxLen: 1000 }, Buffer.from([0x02]), reply, reply));
})();
JS
mapfile -t seen < <(timeout 60 node frames.cjs)
stated 'two replies of 26 bytes' '26 26' "${seen[0]}"
stated 'a scan of 732, a reply' '4 26' "${seen[1]}"
stated 'a scan with values of 02, two replies' '4 4 56' "${seen[2]}"
stated 'the same, maxLen 1000, one reply' '732 26' "${seen[3]}"
stated 'a 02, two replies, maxLen 1000' '4 26' "${seen[4]}"
