// SPDX-License-Identifier: Apache-2.0
// The peer of bench/mcap_write.cpp: the same messages by @mcap/core into chunks of 1 MiB, uncompressed.
//   mcap_write.mjs NODE_MODULES FILE MESSAGES          prints the seconds that it took
import { createRequire } from "node:module";
import { closeSync, openSync, writeSync } from "node:fs";

const [modules, path, count] = process.argv.slice(2);
const { McapWriter } = createRequire(modules + "/")("@mcap/core");

const payload = (size) => Uint8Array.from({ length: size }, () => Math.random() * 256);
const messages = [];
for (let k = 0; k < 500; ++k) messages.push([2 + (k % 5), payload(61)]);
for (let k = 0; k < 125; ++k) messages.push([0, payload(1480)]);
for (let k = 0; k < 30; ++k) messages.push([1, payload(413)]);
messages.sort(() => Math.random() - 0.5);

const begin = process.hrtime.bigint();
const file = openSync(path, "wx");
let at = 0n;
const writable = {
  async write(bytes) {
    at += BigInt(writeSync(file, bytes));
  },
  position: () => at,
};
const writer = new McapWriter({ writable, chunkSize: 1 << 20 });
await writer.start({ profile: "", library: "bench" });
const channels = [];
for (let k = 0; k < 7; ++k) {
  channels.push(await writer.registerChannel({ schemaId: 0, topic: `/topic${k}`, messageEncoding: "raw", metadata: new Map() }));
}
for (let k = 0; k < Number(count); ++k) {
  const [channel, data] = messages[k % messages.length];
  const time = 1000000n * BigInt(k);
  await writer.addMessage({ channelId: channels[channel], sequence: k, logTime: time, publishTime: time, data });
}
await writer.end();
closeSync(file);
console.log(Number(process.hrtime.bigint() - begin) / 1e9);
