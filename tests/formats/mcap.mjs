// SPDX-License-Identifier: MIT
// For recordings.py: MCAP files and CDR messages by npm's packages of those who made MCAP.
//
//   node mcap.mjs cdr < JSON          messages in CDR, by @foxglove/rosmsg2-serialization, as hex
//   node mcap.mjs write < JSON        MCAP files by @mcap/core; chunks by the programs zstd and lz4
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";

// The packages stand in the folder that NODE_PATH names.
const require = createRequire(import.meta.url);
const packer = (program) => (data) =>
  execFileSync(program, ["-c"], { input: data, maxBuffer: 1 << 28 });

class Buffered {
  parts = [];
  size = 0n;
  position() { return this.size; }
  async write(bytes) { this.parts.push(Buffer.from(bytes)); this.size += BigInt(bytes.byteLength); }
}

async function write({ file, profile, packing, options, messages }) {
  const { McapWriter } = require("@mcap/core");
  const writable = new Buffered();
  const packed = packing ? { compressChunk: (data) => (
    { compression: packing, compressedData: packer(packing)(data) }) } : {};
  const writer = new McapWriter({ writable, chunkSize: 4000, ...options, ...packed });
  await writer.start({ profile, library: "" });
  const channels = new Map();
  for (const [sequence, { topic, type, time, hex }] of messages.entries()) {
    if (!channels.has(topic)) {
      const schemaId = await writer.registerSchema(
        { name: type, encoding: profile + "msg", data: new Uint8Array() });
      channels.set(topic, await writer.registerChannel({ schemaId, topic,
        messageEncoding: profile === "ros1" ? "ros1" : "cdr", metadata: new Map() }));
    }
    await writer.addMessage({ channelId: channels.get(topic), sequence, logTime: BigInt(time),
      publishTime: BigInt(time), data: Buffer.from(hex, "hex") });
  }
  await writer.end();
  writeFileSync(file, Buffer.concat(writable.parts));
}

function cdr(messages) {
  const { parse } = require("@foxglove/rosmsg");
  const { MessageWriter } = require("@foxglove/rosmsg2-serialization");
  const hex = messages.map(({ definition, value }) => {
    if (typeof value.data === "string") value.data = new Uint8Array(Buffer.from(value.data, "hex"));
    const writer = new MessageWriter(parse(definition, { ros2: true }));
    return Buffer.from(writer.writeMessage(value)).toString("hex");
  });
  process.stdout.write(JSON.stringify(hex));
}

const input = JSON.parse(readFileSync(0, "utf8"));
if (process.argv[2] === "cdr") cdr(input);
else for (const one of input) await write(one);
