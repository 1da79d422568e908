// SPDX-FileCopyrightText: The Swiftlet authors
// SPDX-License-Identifier: Apache-2.0
//
// node decode.mjs FILE.mcap [N]: reads a recording with the libraries of Foxglove, by its index and
// from the front, decodes every message, and prints header, channels and every Nth message of each
// topic (all without N) as JSON. 64-bit numbers, NaN and infinities become text.
import { open, readFile } from "node:fs/promises";

import ros2idl from "@foxglove/ros2idl-parser";
import serialization from "@foxglove/rosmsg2-serialization";
import lz4 from "@foxglove/wasm-lz4";
import zstd from "@foxglove/wasm-zstd";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";

await lz4.isLoaded;
await zstd.isLoaded;
const decompressHandlers = {
  lz4: (bytes, size) => new Uint8Array(lz4(bytes, Number(size))),
  zstd: (bytes, size) => new Uint8Array(zstd.decompress(bytes, Number(size))),
};

function plain(value) {
  if (typeof value === "bigint") return value.toString();
  if (typeof value === "number") return Number.isFinite(value) ? value : String(value);
  if (ArrayBuffer.isView(value) || Array.isArray(value)) return Array.from(value, plain);
  if (value !== null && typeof value === "object") {
    return Object.fromEntries(Object.entries(value).map(([key, item]) => [key, plain(item)]));
  }
  return value;
}

class Decoder {
  #readers = new Map();

  decode(schema, message) {
    if (!this.#readers.has(schema.id)) {
      const definitions = ros2idl.parseRos2idl(new TextDecoder().decode(schema.data));
      // Foxglove decodes with the first definition that is no module of constants.
      const first = definitions.find((definition) => !/_Constants$/.test(definition.name));
      if (first?.name !== schema.name) {
        throw new Error(`schema ${schema.name} begins with ${first?.name}`);
      }
      this.#readers.set(schema.id, new serialization.MessageReader(definitions));
    }
    const reader = this.#readers.get(schema.id);
    const value = reader.readMessage(message.data);
    if (reader.lastReadHadTrailingBytes()) {
      throw new Error(`${schema.name}: ${reader.lastReadByteLength()} of ${message.data.length} bytes read`);
    }
    return value;
  }
}

async function byIndex(path, every) {
  const file = await open(path, "r");
  const readable = {
    size: async () => BigInt((await file.stat()).size),
    read: async (offset, length) => {
      const bytes = new Uint8Array(Number(length));
      const { bytesRead } = await file.read(bytes, 0, bytes.length, Number(offset));
      if (bytesRead !== bytes.length) throw new Error("the index points behind the end");
      return bytes;
    },
  };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  if (reader.chunkIndexes.length === 0) throw new Error("no chunk index");
  const decoder = new Decoder();
  const messages = [];
  const decoded = {};
  for await (const message of reader.readMessages()) {
    const channel = reader.channelsById.get(message.channelId);
    const schema = reader.schemasById.get(channel.schemaId);
    const value = decoder.decode(schema, message);
    const count = decoded[channel.topic] ?? 0;
    decoded[channel.topic] = count + 1;
    if (count % every !== 0) continue;
    messages.push({
      topic: channel.topic,
      type: schema.name,
      sequence: message.sequence,
      log_time: message.logTime.toString(),
      publish_time: message.publishTime.toString(),
      value: plain(value),
    });
  }
  const attachments = [];
  for await (const attachment of reader.readAttachments()) {
    attachments.push({ name: attachment.name, data: new TextDecoder().decode(attachment.data) });
  }
  const metadata = [];
  for await (const record of reader.readMetadata()) {
    metadata.push({ name: record.name, metadata: Object.fromEntries(record.metadata) });
  }
  await file.close();
  return {
    profile: reader.header.profile,
    statistics: { messages: Number(reader.statistics.messageCount), chunks: reader.statistics.chunkCount },
    compressions: [...new Set(reader.chunkIndexes.map((index) => index.compression))].sort(),
    channels: [...reader.channelsById.values()].map((channel) => ({
      topic: channel.topic,
      message_encoding: channel.messageEncoding,
      schema_encoding: reader.schemasById.get(channel.schemaId).encoding,
      metadata_keys: [...channel.metadata.keys()],
    })),
    attachments,
    metadata,
    decoded,
    messages,
  };
}

/** Checks the checksums of all chunks, and returns the number of messages. */
async function fromTheFront(path) {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  reader.append(new Uint8Array(await readFile(path)));
  let messages = 0;
  for (let record = reader.nextRecord(); record; record = reader.nextRecord()) {
    if (record.type === "Message") messages += 1;
  }
  if (!reader.done()) throw new Error("the file does not end as it should");
  return messages;
}

const path = process.argv[2];
const result = await byIndex(path, Number(process.argv[3] ?? 1));
result.messages_from_the_front = await fromTheFront(path);
console.log(JSON.stringify(result));
