// SPDX-License-Identifier: Apache-2.0
// The part of mcap.sh that reads the file. usage: mcap.js FILE.mcap SCANS.csv WHEELS.tum [RUN.tum]
const fs = require('fs');
const assert = require('assert');
const { McapIndexedReader, McapStreamReader } = require('@mcap/core');
const schemas = require('@foxglove/schemas/jsonschema');
const Ajv = require('ajv');

const [file, csv, tum, runTum] = process.argv.slice(2);
const near = (a, b, within, what) => assert(Math.abs(a - b) <= within, `${what}: ${a} and ${b}`);
const stamp = (time) => time.sec * 1e9 + time.nsec;  // good to a quarter of a microsecond
const rowsOf = (name, separator) => fs.readFileSync(name, 'utf8').trim().split('\n').map((line) => line.split(separator));

/// A schema without what people read in it.
function bare(schema) {
  if (Array.isArray(schema)) return schema.map(bare);
  if (schema === null || typeof schema !== 'object') return schema;
  return Object.fromEntries(Object.entries(schema).filter(([key, value]) => key !== '$comment' && !(key === 'description' && typeof value === 'string'))
    .map(([key, value]) => [key, bare(value)]));
}

async function main() {
  const bytes = fs.readFileSync(file);
  const reader = await McapIndexedReader.Initialize({
    readable: { size: async () => BigInt(bytes.length), read: async (at, size) => bytes.subarray(Number(at), Number(at + size)) },
  });
  const ajv = new Ajv({ strict: false });
  const valid = new Map();
  for (const [id, schema] of reader.schemasById) {
    const text = JSON.parse(Buffer.from(schema.data).toString());
    const published = schemas[schema.name.replace('foxglove.', '')];
    assert.deepStrictEqual(bare(text), bare(published), `${schema.name} is not Foxglove's`);
    valid.set(id, ajv.compile(published));
  }
  const topics = {};
  let before = 0n;
  for await (const message of reader.readMessages()) {
    assert(message.logTime >= before, 'read in order of time');
    before = message.logTime;
    const channel = reader.channelsById.get(message.channelId);
    const content = JSON.parse(Buffer.from(message.data).toString());
    const fits = valid.get(channel.schemaId);
    assert(fits(content), `${channel.topic}: ${JSON.stringify(fits.errors)}`);
    near(Number(message.logTime), stamp(content.timestamp), 512, 'log time');
    (topics[channel.topic] ??= []).push(content);
  }
  const count = Object.values(topics).reduce((sum, all) => sum + all.length, 0);
  assert.strictEqual(Number(reader.statistics.messageCount), count);

  // The same without indices.
  const stream = new McapStreamReader({ validateCrcs: true });
  stream.append(bytes);
  let streamed = 0;
  for (let record; (record = stream.nextRecord());) streamed += record.type === 'Message' ? 1 : 0;
  assert(stream.done() && streamed === count, `${streamed} of ${count} messages without the indices`);

  const scans = rowsOf(csv, ',').slice(1);
  const bySeconds = new Map(scans.map((row) => [row[0], row]));
  let beams = 0;
  for (const scan of topics['/scan'] ?? []) {
    const row = bySeconds.get(`${scan.timestamp.sec}.${String(scan.timestamp.nsec).padStart(9, '0')}`);
    assert(row, 'a scan of the recording');
    near(scan.start_angle, Number(row[5]), 1e-8, 'first bearing');
    row[8].split(' ').forEach((text, i) => {
      near(scan.ranges[i], text === 'inf' || text === 'nan' ? 0 : Number(text), 1e-9, `range ${i}`);
      beams += 1;
    });
  }
  const comparePoses = (messages, name) => {
    const rows = rowsOf(name, ' ');
    const found = new Map(rows.map((row) => [row[0], row]));
    for (const message of messages) {
      const row = found.get(`${message.timestamp.sec}.${String(message.timestamp.nsec).padStart(9, '0')}`);
      assert(row, 'a pose of the trajectory');
      near(message.pose.position.x, Number(row[1]), 1e-6, 'x');
      near(message.pose.position.y, Number(row[2]), 1e-6, 'y');
      near(message.pose.orientation.z, Number(row[6]), 1e-6, 'qz');
    }
  };
  if (!runTum) assert.strictEqual((topics['/scan'] ?? []).length, scans.length);
  comparePoses(topics['/odom'] ?? [], tum);
  if (runTum) comparePoses(topics['/pose'], runTum);
  for (const map of topics['/map'] ?? []) {
    assert.strictEqual(Buffer.from(map.data, 'base64').length % map.column_count, 0);
  }
  console.log(`${file}: ${Object.entries(topics).map(([topic, all]) => `${topic} ${all.length}`).join(', ')}; ${beams} beams equal`);
}

main().catch((error) => {
  console.error(`mcap: ${error.message}`);
  process.exit(1);
});
