#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: Node's PacketLengthParser, told of a delimiter of two bytes (FA FB of a Pioneer), drops what comes before one, as it
#   does with one byte (02 of an LMS200), and finds the next packet after a byte of noise.
# Seen: without noise every packet comes out whole. After a single other byte, at the start or between two packets, nothing
#   comes out any more, ever: of the two bytes that it compares it throws away the newer and keeps the older, so 09 is compared
#   with every byte that follows. Noise that is itself FA does no harm, and neither does any with a delimiter of one byte.
# Matters: a port that is opened in mid-packet, which is how a port is opened, is deaf from the start, and one that runs falls
#   silent at the first disturbed byte, without an error or an event. Tests on recorded whole packets pass. Give the first byte
#   alone as delimiter and check the second yourself, or make the parser anew after a second of silence.
# Version: @serialport/parser-packet-length 13.0.0 (npm). Source: _transform in its index.js (subarray from 1 of a buffer that
#   has the newest byte first); pull request 2709 of node-serialport, which brought delimiters of several bytes.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

npm_packages @serialport/parser-packet-length@13.0.0
cat > packets.js << 'JS'
const { PacketLengthParser } = require('@serialport/parser-packet-length');

const pioneer = { delimiter: 0xfafb, delimiterBytes: 2, lengthOffset: 2, packetOverhead: 3 };
const laser = { delimiter: 0x02, lengthOffset: 2, lengthBytes: 2, packetOverhead: 6 };
const pulse = [0xfa, 0xfb, 0x03, 0x00, 0x00, 0x00];
const telegram = [0x02, 0x80, 0x03, 0x00, 0x90, 0x01, 0x02, 0xaa, 0xbb];
const twenty = (packet) => Array(20).fill(packet).flat();

async function wholePackets(options, packet, bytes) {
  const parser = new PacketLengthParser(options);
  let whole = 0;
  parser.on('data', (data) => (whole += data.equals(Buffer.from(packet))));
  for (const byte of bytes) parser.write(Buffer.from([byte]));
  await new Promise((resolve) => setTimeout(resolve, 100));
  return whole;
}

(async () => {
  const counts = [
    await wholePackets(pioneer, pulse, twenty(pulse)),
    await wholePackets(pioneer, pulse, [0x09, ...twenty(pulse)]),
    await wholePackets(pioneer, pulse, [...twenty(pulse), 0x09, ...twenty(pulse)]),
    await wholePackets(pioneer, pulse, [0xfa, ...twenty(pulse)]),
    await wholePackets(laser, telegram, [0x09, ...twenty(telegram), 0x09, ...twenty(telegram)]),
  ];
  console.log(counts.join(', '));
})();
JS
stated 'of 20; 20 after 09; 20, 09, 20; 20 after FA; one byte: 09, 20, 09, 20' '20, 0, 20, 20, 40' "$(timeout 60 node packets.js)"
