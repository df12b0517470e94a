// SPDX-License-Identifier: Apache-2.0
// Reads the chunks of a recording again, with the index of the first pass. Streams that are read
// together share chunks: a chunk in the cache is not read and unpacked again.
#pragma once

#include "kinalign/core/file_version.h"
#include "kinalign/core/files.h"
#include "kinalign/mcap/records.h"
#include "kinalign/wire/time.h"

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kinalign {

/// The position of a chunk, or of a message outside of chunks, and the messages in it to take.
struct StoredChunk {
  std::uint32_t part = 0;               // index of the file in the recording
  bool is_truncated = false;            // the file ends within the chunk
  std::uint64_t at = 0, size = 0;       // position and size in the file, bytes
  std::vector<std::uint16_t> channels;  // channels with messages in the chunk, ascending
  std::uint32_t end = 0;                // one more than the index of the last message to take
  /// Messages before `end` to skip, by their index in the chunk, ascending. They are damaged, or
  /// another file of the recording has them, too.
  std::vector<std::uint32_t> left_out;
};

/// A message of an opened chunk. `data` is a view of the chunk's bytes.
struct ChunkMessage {
  std::uint16_t channel = 0;
  std::uint64_t log_time = 0;  // ns, UTC
  std::string_view data;
};

/// A chunk after reading and unpacking. Passes share it, and it exists while any of them uses it.
struct OpenedChunk {
  std::string bytes;                   // the data of `messages` are views of these bytes
  std::vector<ChunkMessage> messages;  // the messages to take, in the order of the chunk

  std::size_t memory() const {
    return bytes.capacity() + messages.capacity() * sizeof(messages[0]);
  }
};

/// The chunks of all parts. Several threads may use this class at once; one lock protects files and
/// cache. A file stays open once its first chunk was needed. The cache contains the newest chunks:
/// at most `most_cached` bytes, but always at least one chunk.
class StoredChunks {
 public:
  /// The limit on the memory of the cache, bytes. A lab of seven devices fills the cache in about
  /// 280 s. Streams that align reads together are at most 240 s apart (align/slabs.h).
  static constexpr std::size_t most_cached = std::size_t{64} << 20;

  struct File {
    std::string path;
    std::optional<FileVersion> version;  // the file's version when it was indexed
  };
  /// `files` must exist longer than this object.
  StoredChunks(FileSystem& files, std::vector<File> parts, std::vector<StoredChunk> chunks);

  std::size_t size() const { return chunks_.size(); }
  std::uint64_t bytes() const { return bytes_; }  // size of all chunks in the files
  const StoredChunk& operator[](std::size_t k) const { return chunks_[k]; }
  /// Returns chunk `k`. Fails if the file has changed since it was indexed.
  Result<std::shared_ptr<const OpenedChunk>> open(std::size_t k) const;

 private:
  Result<std::shared_ptr<const OpenedChunk>> read(const StoredChunk& chunk) const;

  FileSystem* files_;
  std::vector<File> parts_;
  std::vector<StoredChunk> chunks_;
  std::uint64_t bytes_ = 0;
  mutable std::mutex mutex_;
  mutable std::vector<std::optional<InputFile>> open_files_;  // one for each part
  // Opened chunks by their index, in the order of opening.
  mutable std::deque<std::pair<std::size_t, std::shared_ptr<const OpenedChunk>>> cache_;
  mutable std::size_t cached_bytes_ = 0;
};

/// One pass over the messages of some channels, in the order of the files. The pass keeps no chunk
/// after using it.
class MessagePass {
 public:
  MessagePass(std::shared_ptr<const StoredChunks> chunks, std::vector<std::uint16_t> channels);

  using Take = std::function<Result<void>(const ChunkMessage&)>;
  /// Passes on the messages of the next chunk that has any. Returns false after the last chunk.
  Result<bool> next_chunk(const Take& take);
  /// The bytes of all chunks that the pass has read, and of all chunks of the recording.
  std::uint64_t done() const { return done_; }
  std::uint64_t all() const { return chunks_->bytes(); }

 private:
  std::shared_ptr<const StoredChunks> chunks_;
  std::vector<std::uint16_t> channels_;  // ascending
  std::size_t next_ = 0;
  std::uint64_t done_ = 0;
};

}  // namespace kinalign
