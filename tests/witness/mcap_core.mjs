// SPDX-License-Identifier: Apache-2.0
// What @mcap/core makes of recordings: mcap_core.mjs NODE_MODULES stream|indexed|texts FILE [CUT...]
// Prints a line of JSON for each cut (the whole file where none is given): the messages that a reader
// of bytes from front to end, or one that goes by the index, has seen; with `texts` from front to end
// their topics, times and data.
import { createRequire } from "node:module";
import { readFileSync } from "node:fs";

const [modules, how, path, ...cuts] = process.argv.slice(2);
const require = createRequire(modules + "/");
const { McapStreamReader, McapIndexedReader } = require("@mcap/core");
const { decompress } = require("fzstd");
const decompressHandlers = { zstd: (bytes) => decompress(bytes) };
const whole = new Uint8Array(readFileSync(path));

const seen = (message) => [message.channelId, message.sequence, String(message.logTime), message.data.byteLength];

const text = (message, topic) =>
  [topic, String(message.logTime), String(message.publishTime), new TextDecoder().decode(message.data)];

function fromFrontToEnd(bytes, shown) {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  const messages = [], topics = new Map();
  try {
    reader.append(bytes);
    for (let record; (record = reader.nextRecord()); ) {
      if (record.type === "Channel") topics.set(record.id, record.topic);
      if (record.type === "Message") messages.push(shown(record, topics.get(record.channelId)));
    }
    return { messages, done: reader.done() };
  } catch (error) {
    return { messages, error: error.message };
  }
}

async function byTheIndex(bytes) {
  const readable = {
    size: async () => BigInt(bytes.byteLength),
    read: async (at, length) => bytes.slice(Number(at), Number(at + length)),
  };
  try {
    const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
    const messages = [];
    for await (const message of reader.readMessages({ validateCrcs: true })) messages.push(seen(message));
    return { messages, counted: Number(reader.statistics.messageCount) };
  } catch (error) {
    return { messages: [], error: error.message };
  }
}

for (const cut of cuts.length > 0 ? cuts.map(Number) : [whole.byteLength]) {
  const bytes = whole.subarray(0, cut);
  const read = how === "indexed" ? await byTheIndex(bytes) : fromFrontToEnd(bytes, how === "texts" ? text : seen);
  console.log(JSON.stringify(read));
}
