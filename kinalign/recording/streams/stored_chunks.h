// SPDX-License-Identifier: Apache-2.0
// The chunks of a recording, read again by the index that its first pass has made. Streams that are
// read side by side share each chunk: it is read and unpacked once, while it lies in the cache.
#pragma once

#include "kinalign/core/file_version.h"
#include "kinalign/core/files.h"
#include "kinalign/mcap/records.h"
#include "kinalign/wire/time.h"

#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// Where a chunk stands, or a message that stands in none, and what the first pass found in it.
struct StoredChunk {
  std::uint32_t part = 0;               // the file, by its number in the recording
  bool is_torn = false;                 // the file ends within it
  std::uint64_t at = 0, size = 0;       // bytes of the file
  std::vector<std::uint16_t> channels;  // that have messages here, rising
  /// Messages that do not count, by their place in the chunk, rising: damaged, or found in another
  /// file of the recording.
  std::vector<std::uint32_t> left_out;
};

struct ChunkMessage {
  std::uint16_t channel = 0;
  std::uint64_t log_time = 0;  // ns
  std::string_view data;
};

struct OpenedChunk {
  std::string bytes;                   // that `messages` points into
  std::vector<ChunkMessage> messages;  // those that count, in their order

  std::size_t memory() const {
    return bytes.capacity() + messages.capacity() * sizeof(messages[0]);
  }
};

/// Safe to use from several threads at once.
class StoredChunks {
 public:
  /// Bytes of memory that the cache takes: a lab of seven devices fills it in some 280 s. align
  /// reads its streams within two slabs of each other, at most 240 s (align/slabs.h).
  static constexpr std::size_t most_cached = std::size_t{64} << 20;

  struct File {
    std::string path;
    std::optional<FileVersion> version;  // when it was indexed
  };
  /// `files` must outlive the chunks.
  StoredChunks(FileSystem& files, std::vector<File> parts, std::vector<StoredChunk> chunks);

  std::size_t size() const { return chunks_.size(); }
  std::uint64_t bytes() const { return bytes_; }  // of all chunks in the files
  const StoredChunk& operator[](std::size_t k) const { return chunks_[k]; }
  /// Fails where the file has changed since it was indexed.
  Result<std::shared_ptr<const OpenedChunk>> open(std::size_t k) const;

 private:
  Result<std::shared_ptr<const OpenedChunk>> read(const StoredChunk& chunk) const;

  struct Cached {
    std::size_t chunk = 0;
    std::shared_ptr<const OpenedChunk> opened;
  };
  FileSystem* files_;
  std::vector<File> parts_;
  std::vector<StoredChunk> chunks_;
  std::uint64_t bytes_ = 0;
  mutable std::mutex mutex_;
  mutable std::vector<std::optional<InputFile>> open_files_;  // by part
  mutable std::list<Cached> cache_;                           // used last first
  mutable std::map<std::size_t, std::list<Cached>::iterator> places_;
  mutable std::size_t cached_bytes_ = 0;
};

/// A channel of JSON that the recorder itself wrote: marks, counts, the host's clocks.
struct JsonChannel {
  std::uint16_t id = 0;
  std::string topic;
  McapSchema schema;
};

/// Goes once through the messages of some channels, in the order of the files.
class MessagePass {
 public:
  MessagePass(std::shared_ptr<const StoredChunks> chunks, std::vector<std::uint16_t> channels);

  using Take = std::function<Result<void>(const ChunkMessage&)>;
  /// Hands on the messages of the next chunk that has any; false behind the last one.
  Result<bool> next_chunk(const Take& take);
  /// Bytes of the chunks that it has passed, and of all chunks.
  std::uint64_t done() const { return done_; }
  std::uint64_t all() const { return chunks_->bytes(); }

 private:
  std::shared_ptr<const StoredChunks> chunks_;
  std::vector<std::uint16_t> channels_;  // rising
  std::size_t next_ = 0;
  std::uint64_t done_ = 0;
};

}  // namespace kinalign
