#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Guess: MCAP's own reader for JavaScript brings every message of a whole file; where it needs chunks and the file has none,
#   which the format allows, it says so.
# Seen: a file that its own writer wrote with useChunks: false is opened, its summary says three messages from 100 to 300 ns,
#   and readMessages ends at once without one, and without an error. Written in chunks it brings all three; the reader of
#   streams brings them from both. Only chunks without an index of messages are refused in words.
# Matters: a recorder may leave the chunks away (noChunking of ROS 2's rosbag2_storage_mcap). A page or a script that shows
#   such a drive shows an empty one: look whether chunkIndexes is empty, and go by McapStreamReader then.
# Version: @mcap/core 2.2.2 (npm). Source: MCAP's specification, "Message": may stand in the data section or in a chunk;
#   McapIndexedReader takes its time range from chunk indices alone and returns where there are none.
set -euo pipefail
source "$(dirname "$0")/lib/pinned.bash"

npm_packages @mcap/core@2.2.2
cat > drive.mjs << 'JS'
import { McapIndexedReader, McapStreamReader, McapWriter } from '@mcap/core';

class File {
  bytes = new Uint8Array();
  position() { return BigInt(this.bytes.length); }
  async write(more) { this.bytes = Uint8Array.from([...this.bytes, ...more]); }
  async size() { return BigInt(this.bytes.length); }
  async read(offset, size) { return this.bytes.slice(Number(offset), Number(offset + size)); }
}

for (const options of [{ useChunks: true }, { useChunks: false }, { useChunks: true, useMessageIndex: false }]) {
  const file = new File();
  const writer = new McapWriter({ writable: file, ...options });
  await writer.start({ profile: '', library: '' });
  const channelId = await writer.registerChannel({ schemaId: 0, topic: '/scan', messageEncoding: 'json', metadata: new Map() });
  for (const stamp of [100n, 200n, 300n]) {
    await writer.addMessage({ channelId, sequence: 0, logTime: stamp, publishTime: stamp, data: new TextEncoder().encode('{}') });
  }
  await writer.end();

  const reader = await McapIndexedReader.Initialize({ readable: file });
  const { messageCount, messageStartTime, messageEndTime } = reader.statistics;
  let indexed = 0;
  try {
    for await (const message of reader.readMessages()) indexed += message.channelId === channelId;
  } catch {
    indexed = 'an error';
  }
  const stream = new McapStreamReader();
  stream.append(file.bytes);
  let streamed = 0;
  for (let record; (record = stream.nextRecord());) streamed += record.type === 'Message';
  const told = `${messageCount} of ${messageStartTime}-${messageEndTime}`;
  console.log(`${Object.values(options)}: ${told}, indexed ${indexed}, streamed ${streamed}`);
}
JS
expected='true: 3 of 100-300, indexed 3, streamed 3|false: 3 of 100-300, indexed 0, streamed 3|'
expected+='true,false: 3 of 100-300, indexed an error, streamed 3'
stated 'chunks[, index]: summary, read' "$expected" "$(timeout 60 node drive.mjs | paste -sd '|')"
