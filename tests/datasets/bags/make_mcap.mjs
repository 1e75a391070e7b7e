// SPDX-License-Identifier: MIT
// Writes the MCAP files of tests/fuzz/corpus/bag_mcap/ that another program made: npm's @mcap/core, with the
// chunks packed by the programs zstd and lz4.
//
//   npm install @mcap/core && node tests/datasets/bags/make_mcap.mjs tests/fuzz/corpus/bag_mcap
import { execFileSync } from "node:child_process";
import { writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";

const require = createRequire(pathToFileURL(process.cwd() + "/"));
const { McapWriter } = require("@mcap/core");

class Buffered {
  parts = [];
  size = 0n;
  position() { return this.size; }
  async write(bytes) { this.parts.push(Buffer.from(bytes)); this.size += BigInt(bytes.byteLength); }
}

// Three points messages and two poses; recorded out of order, and two of them at the same time.
const messages = [
  ["/points", 0, 1000n, "points 0"], ["/pose", 0, 1500n, "pose 0"], ["/points", 1, 3000n, "points 2"],
  ["/points", 2, 2000n, "points 1"], ["/pose", 1, 1500n, "pose 1"],
];

async function write(name, options) {
  const writable = new Buffered();
  const writer = new McapWriter({ writable, chunkSize: 100, ...options });
  await writer.start({ profile: "ros2", library: "a test" });
  const schemas = new Map(), channels = new Map();
  for (const [topic, type] of [["/points", "sensor_msgs/msg/PointCloud2"],
                               ["/pose", "geometry_msgs/msg/PoseStamped"]]) {
    schemas.set(topic, await writer.registerSchema(
      { name: type, encoding: "ros2msg", data: new Uint8Array([35]) }));
    channels.set(topic, await writer.registerChannel(
      { schemaId: schemas.get(topic), topic, messageEncoding: "cdr",
        metadata: new Map([["offered_qos_profiles", ""]]) }));
  }
  await writer.addAttachment({ logTime: 5n, createTime: 4n, name: "note.txt",
    mediaType: "text/plain", data: new Uint8Array([104, 105]) });
  for (const [topic, sequence, time, text] of messages) {
    await writer.addMessage({ channelId: channels.get(topic), sequence, logTime: time,
      publishTime: time, data: Buffer.from("\0\x01\0\0" + text) });
  }
  await writer.addMetadata({ name: "robot", metadata: new Map([["wheels", "4"]]) });
  await writer.end();
  writeFileSync(`${process.argv[2]}/${name}.mcap`, Buffer.concat(writable.parts));
}

const bare = { useStatistics: false, useSummaryOffsets: false, useChunkIndex: false,
  repeatSchemas: false, repeatChannels: false, useMessageIndex: false };
await write("chunks", {});
for (const program of ["zstd", "lz4"]) {
  await write(program, { compressChunk: (data) => ({
    compression: program, compressedData: execFileSync(program, ["-c"], { input: data }) }) });
}
await write("no_chunks", { useChunks: false });
await write("no_statistics", { useStatistics: false });
await write("no_schemas", { repeatSchemas: false });
await write("no_message_index", { useMessageIndex: false });
await write("bare", bare);
