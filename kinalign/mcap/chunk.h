// SPDX-License-Identifier: Apache-2.0
// A chunk of an MCAP file while it is filled, and as it is stored. Filling copies a message once;
// compressing and summing are for another thread than the one that receives.
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

/// By id.
struct McapDefinitions {
  std::map<std::uint16_t, McapSchema> schemas;
  std::map<std::uint16_t, McapChannel> channels;
};

/// Messages and the definitions that they need, so that a chunk can be read by itself.
class McapChunkContent {
 public:
  /// A channel stands before its first message here, its schema before it.
  void add(const McapSchema& schema);
  void add(const McapChannel& channel);
  void add(const McapMessage& message);

  bool empty() const { return messages_.empty(); }
  std::size_t size() const { return records_.size(); }  // bytes

  const std::string& records() const { return records_; }
  const McapDefinitions& definitions() const { return definitions_; }
  /// By channel, in the order in which they were added.
  const std::map<std::uint16_t, std::vector<McapMessageEntry>>& messages() const {
    return messages_;
  }
  std::uint64_t start() const { return start_; }  // the least and the greatest log time, ns
  std::uint64_t end() const { return end_; }

 private:
  std::string records_;
  McapDefinitions definitions_;
  std::map<std::uint16_t, std::vector<McapMessageEntry>> messages_;
  std::uint64_t start_ = 0, end_ = 0;
};

/// The chunk's record and, behind it, its message indexes.
struct McapStoredChunk {
  std::string bytes;
  std::uint32_t crc = 0;                                    // of these
  McapChunkIndex index;                                     // offsets count from the first byte
  std::map<std::uint16_t, std::uint64_t> channel_messages;  // how many
  McapDefinitions definitions;
};
/// zstd's level 1: higher ones gain nothing on motion, and are slower (performance.md, recording).
McapStoredChunk store(const McapChunkContent& content, McapCompression compression);

/// A chunk's records as they were before they were compressed. `most`: bytes that they may have.
/// Fails where it is not whole, its sizes or checksum do not fit, or the compression is none of
/// ours.
Result<std::string> unpack(const McapChunkView& chunk, std::uint64_t most);
/// As many of them as a torn end leaves, from the front: nothing has checked them.
std::string unpack_torn(const McapChunkView& chunk, std::uint64_t most);

}  // namespace kinalign
