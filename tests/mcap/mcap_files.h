// SPDX-License-Identifier: Apache-2.0
// MCAP files in memory, for tests: written message by message, read back in pieces.
#pragma once

#include "kinalign/mcap/reader.h"
#include "kinalign/mcap/writer.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

namespace kinalign {

struct MemoryFile {
  std::string bytes;

  McapStore store() {
    return {[this](std::string_view more) {
              bytes += more;
              return Result<void>();
            },
            [this](std::uint64_t at, std::span<char> to) {
              std::memcpy(to.data(), bytes.data() + at, to.size());
              return Result<void>();
            }};
  }
};

/// A message with its own copy of the data.
struct OwnedMessage {
  McapMessage message;
  std::string data;
  bool unchecked = false;
};

struct ReadMcap {
  std::vector<McapRecord> records;  // all records but messages, whose data would not stay valid
  std::vector<OwnedMessage> messages;
  Findings findings;
  bool closed = false;
  /// The last message had no checksum; all records of a closed file had one.
  bool unchecked = false, all_checked = false;
};

inline ReadMcap read_mcap(std::string_view bytes, std::size_t piece = std::size_t{64} << 10) {
  McapReader reader;
  ReadMcap read;
  const auto take_all = [&] {
    while (const auto record = reader.next()) {
      if (const auto* message = std::get_if<McapMessage>(&*record)) {
        read.unchecked = reader.unchecked();
        read.messages.push_back({*message, std::string(message->data), read.unchecked});
      } else {
        read.records.push_back(*record);
      }
    }
  };
  for (; !bytes.empty(); bytes.remove_prefix(std::min(piece, bytes.size()))) {
    reader.feed(bytes.substr(0, piece));
    take_all();
  }
  reader.end();
  take_all();
  read.findings = reader.findings();
  read.closed = reader.closed();
  read.all_checked = reader.all_checked();
  return read;
}

/// The k-th message of a test: on one of three channels, a different length and content each.
inline OwnedMessage nth_message(std::uint32_t k) {
  OwnedMessage m{{static_cast<std::uint16_t>(1 + k % 3), k, 1000 + 10 * k, 500 + 7 * k, {}}, {}};
  m.data.assign(20 + k % 50, static_cast<char>('a' + k % 26));
  return m;
}

inline void add(McapChunkContent& content, const OwnedMessage& m) {
  const auto id = m.message.channel;
  if (!content.messages().contains(id)) {
    content.add(McapSchema{id, "schema" + std::to_string(id), "jsonschema", "{}"});
    content.add(McapChannel{id, id, "/topic" + std::to_string(id), "json", {{"device", "x"}}});
  }
  McapMessage message = m.message;
  message.data = m.data;
  content.add(message);
}

/// A whole file of `messages` messages, `a_chunk` in each chunk; `ends` gets the end of each chunk.
inline std::string mcap_file(std::uint32_t messages, std::uint32_t a_chunk,
                             McapCompression compression, std::vector<std::size_t>* ends = nullptr,
                             bool finish = true) {
  MemoryFile file;
  McapWriter writer(file.store());
  (void)writer.begin({"kinalign", "test"});
  (void)writer.write(McapMetadata{"kinalign.recording", {{"subject", "03"}}});
  for (std::uint32_t k = 0; k < messages;) {
    McapChunkContent content;
    for (const std::uint32_t end = std::min(k + a_chunk, messages); k < end; ++k) {
      add(content, nth_message(k));
    }
    (void)writer.write(store(content, compression));
    if (ends != nullptr) ends->push_back(file.bytes.size());
  }
  if (finish) (void)writer.finish();
  return file.bytes;
}

}  // namespace kinalign
