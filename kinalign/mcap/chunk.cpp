// SPDX-License-Identifier: Apache-2.0
#include "kinalign/mcap/chunk.h"

#include "kinalign/core/crc.h"

#include <zstd.h>

#include <algorithm>
#include <memory>

namespace kinalign {

namespace {

constexpr int zstd_level = 1;
constexpr std::uint64_t most_reserved = 16 << 20;  // bytes, before decompression

std::string compressed(std::string_view bytes) {
  // The buffer has the largest possible size, so a single call is enough.
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size =
      ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), zstd_level);
  out.resize(ZSTD_isError(size) != 0 ? 0 : size);  // the call can only fail without memory
  return out;
}

/// Decompresses as much of `stored` as is complete. Stops soon after `most` bytes. The stream is
/// decompressed block by block. A truncated stream therefore gives its beginning, and a small file
/// can't demand much memory.
std::string decompressed(std::string_view stored, std::uint64_t most) {
  std::string records;
  const std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)> stream(ZSTD_createDStream(),
                                                                          &ZSTD_freeDStream);
  if (stream == nullptr) return records;
  ZSTD_inBuffer in{stored.data(), stored.size(), 0};
  std::string block(ZSTD_DStreamOutSize(), '\0');
  // `most` comes from the file and may be wrong, so little memory is reserved in advance.
  records.reserve(std::min<std::uint64_t>(most, most_reserved));
  // ZSTD_decompressStream() returns 0 at the end of a frame.
  for (std::size_t more = 1; more != 0 && records.size() <= most;) {
    const std::size_t had = in.pos;
    ZSTD_outBuffer out{block.data(), block.size(), 0};
    more = ZSTD_decompressStream(stream.get(), &out, &in);
    if (ZSTD_isError(more) != 0) break;
    records.append(block, 0, out.pos);
    // If the call uses no input and makes no output, the stream is truncated.
    if (out.pos == 0 && in.pos == had) break;
  }
  return records;
}

Failure unfit(std::string expected, std::string found) {
  return Failure(Error{"", 0, std::move(expected), std::move(found)});
}

Failure misfit(const McapChunkHead& head, std::uint64_t size) {
  return unfit("a chunk of " + std::to_string(head.uncompressed_size) + " bytes",
               std::to_string(size));
}

}  // namespace

void McapChunkContent::add(const McapSchema& schema) {
  // If a definition is added again, the entry is replaced and its record is written again.
  definitions_.schemas.insert_or_assign(schema.id, schema);
  append_mcap(records_, schema);
}

void McapChunkContent::add(const McapChannel& channel) {
  definitions_.channels.insert_or_assign(channel.id, channel);
  append_mcap(records_, channel);
}

void McapChunkContent::add(const McapMessage& message) {
  start_ = empty() ? message.log_time : std::min(start_, message.log_time);
  end_ = std::max(end_, message.log_time);
  // The offset is a position within the uncompressed chunk.
  messages_[message.channel].push_back({message.log_time, records_.size()});
  append_mcap(records_, message);
}

namespace {

/// An upper limit on the bytes of a chunk and its message indexes.
std::size_t room_for(std::string_view stored, const McapChunkContent& content) {
  constexpr std::size_t heads = 128;  // bytes of the head of a chunk or of an index
  std::size_t room = stored.size() + heads;
  for (const auto& [channel, entries] : content.messages()) {
    room += heads + entries.size() * sizeof(entries.front());
  }
  return room;
}

}  // namespace

// If compression fails for lack of memory, the records are stored uncompressed. Offsets in the
// index count from the chunk's first byte. The writer adds the chunk's position in the file.
McapStoredChunk store(const McapChunkContent& content, McapCompression compression) {
  const std::string_view records = content.records();
  const std::string packed =
      compression == McapCompression::zstd ? compressed(records) : std::string();
  const bool is_packed = !packed.empty();
  const std::string_view stored = is_packed ? std::string_view(packed) : records;
  const McapChunkHead head{content.start(), content.end(), records.size(), crc_of(records),
                           is_packed ? "zstd" : ""};

  McapStoredChunk chunk;
  chunk.definitions = content.definitions();
  chunk.bytes.reserve(room_for(stored, content));
  append_mcap(chunk.bytes, head, stored);
  chunk.index = {
      head.start,    head.end,      0, chunk.bytes.size(), {}, 0, std::string(head.compression),
      stored.size(), records.size()};
  // With these indexes, readers find the messages of one channel without decompressing other
  // chunks.
  for (const auto& [channel, entries] : content.messages()) {
    chunk.index.message_index_offsets[channel] = chunk.bytes.size();
    chunk.channel_messages[channel] = entries.size();
    append_mcap_message_index(chunk.bytes, channel, entries);
  }
  chunk.index.message_index_length = chunk.bytes.size() - chunk.index.chunk_length;
  chunk.crc = crc_of(chunk.bytes);
  return chunk;
}

Result<std::string> unpack(const McapChunkView& chunk, std::uint64_t most) {
  const McapChunkHead& head = chunk.head;
  if (!chunk.whole()) return unfit("a whole chunk", "its beginning");
  // The stated size determines the memory, so it is checked first.
  if (head.uncompressed_size > most) {
    return unfit("a chunk of at most " + std::to_string(most >> 20) + " MiB",
                 std::to_string(head.uncompressed_size >> 20) + " MiB");
  }
  if (!head.compression.empty() && head.compression != "zstd") {
    return unfit("a chunk that is uncompressed or compressed by zstd", shown(head.compression));
  }
  if (head.compression.empty() && chunk.stored_size != head.uncompressed_size) {
    return misfit(head, chunk.stored_size);  // checked before the records are copied
  }
  std::string records = unpack_truncated(chunk, most);
  // A zstd stream may contain fewer or more bytes than the head states.
  if (records.size() != head.uncompressed_size) return misfit(head, records.size());
  if (head.uncompressed_crc != 0 && head.uncompressed_crc != crc_of(records)) {
    return unfit("a chunk with a correct checksum", "another one");
  }
  return records;
}

std::string unpack_truncated(const McapChunkView& chunk, std::uint64_t most) {
  // The checksum of a truncated chunk can't be compared, because part of the data is missing.
  most = std::min(most, chunk.head.uncompressed_size);
  if (chunk.head.compression == "zstd") return decompressed(chunk.stored, most);
  return std::string(chunk.head.compression.empty() ? chunk.stored : std::string_view());
}

}  // namespace kinalign
