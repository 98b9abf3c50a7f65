// Prints the messages of an MCAP file as @mcap/core reads them, one in a line:
// topic, time, publish time, sequence, SHA-256 of the bytes.
//
//     node tests/bag/mcap_core.mjs FOLDER FILE
//
// FOLDER has the node_modules with @mcap/core, fzstd and lz4js.

import { createHash } from "node:crypto";
import { open } from "node:fs/promises";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";

const [folder, path] = process.argv.slice(2);
const require = createRequire(join(resolve(folder), "main.js"));
const { McapIndexedReader } = require("@mcap/core");
const zstd = require("fzstd");
const lz4 = require("lz4js");

const file = await open(path);
const readable = {
  size: async () => BigInt((await file.stat()).size),
  read: async (offset, length) => {
    const buffer = new Uint8Array(Number(length));
    const { bytesRead } = await file.read(buffer, 0, buffer.length, Number(offset));
    if (bytesRead !== buffer.length) {
      throw new Error(`${path} ends before byte ${offset + length}`);
    }
    return buffer;
  },
};
const reader = await McapIndexedReader.Initialize({
  readable,
  decompressHandlers: {
    zstd: (buffer, size) => zstd.decompress(buffer, new Uint8Array(Number(size))),
    lz4: (buffer) => lz4.decompress(buffer),
  },
});
let count = 0n;
for await (const message of reader.readMessages({ validateCrcs: true })) {
  const { topic } = reader.channelsById.get(message.channelId);
  const digest = createHash("sha256").update(message.data).digest("hex");
  const { logTime, publishTime, sequence } = message;
  console.log(`${topic} ${logTime} ${publishTime} ${sequence} ${digest}`);
  count += 1n;
}
if (count !== reader.statistics.messageCount) {
  throw new Error(`${count} messages, and the summary says ${reader.statistics.messageCount}`);
}
await file.close();
