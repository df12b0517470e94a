// SPDX-License-Identifier: Apache-2.0
// A chunk of an MCAP file, first while messages are added, then as it is stored. Adding copies each
// message once. Compression and checksums can run in another thread than the receiver.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/mcap/records.h"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

enum class McapCompression : std::uint8_t { none, zstd };

/// Schemas and channels by id.
struct McapDefinitions {
  std::map<std::uint16_t, McapSchema> schemas;
  std::map<std::uint16_t, McapChannel> channels;
};

/// Messages with the definitions that they need, so that the chunk can be read alone. records()
/// returns the bytes of the future chunk. The other members describe these bytes, so that nothing
/// needs to be parsed again.
class McapChunkContent {
 public:
  /// A channel must be added before its first message, and its schema before the channel.
  void add(const McapSchema& schema);
  void add(const McapChannel& channel);
  void add(const McapMessage& message);

  bool empty() const { return messages_.empty(); }
  std::size_t size() const { return records_.size(); }  // bytes

  const std::string& records() const { return records_; }
  const McapDefinitions& definitions() const { return definitions_; }
  /// Messages by channel, in the order in which they were added.
  const std::map<std::uint16_t, std::vector<McapMessageEntry>>& messages() const {
    return messages_;
  }
  std::uint64_t start() const { return start_; }  // lowest log time, ns
  std::uint64_t end() const { return end_; }

 private:
  // The offset of each entry in messages_ is a position in records_. start_ and end_ are 0 before
  // the first message.
  std::string records_;
  McapDefinitions definitions_;
  std::map<std::uint16_t, std::vector<McapMessageEntry>> messages_;
  std::uint64_t start_ = 0, end_ = 0;
};

/// A chunk's record, followed by its message indexes. `bytes` can be written at any position of a
/// file, and the writer adds that position to the index. The checksum is computed here, because
/// store() runs in a worker thread.
struct McapStoredChunk {
  std::string bytes;
  std::uint32_t crc = 0;  // CRC-32 of `bytes`
  McapChunkIndex index;   // offsets count from the first byte of `bytes`
  std::map<std::uint16_t, std::uint64_t> channel_messages;  // number of messages by channel
  McapDefinitions definitions;
};
/// Packs a chunk. zstd uses level 1. Higher levels are slower, and make motion data no smaller
/// (docs/performance_recording.md).
McapStoredChunk store(const McapChunkContent& content, McapCompression compression);

/// Unpacks the records of a chunk. `most`: the caller's limit on their bytes, whatever size the
/// chunk states. Fails if the chunk is incomplete, if a size or checksum is wrong, or if the
/// compression is neither none nor zstd.
Result<std::string> unpack(const McapChunkView& chunk, std::uint64_t most);
/// Unpacks the present beginning of a truncated chunk. No checksum is compared.
std::string unpack_truncated(const McapChunkView& chunk, std::uint64_t most);

}  // namespace kinalign
