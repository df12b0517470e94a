// SPDX-License-Identifier: Apache-2.0
// Reads the chunks of a recording again, using the index of the first pass. Streams that are read
// together share each chunk: it is read and unpacked once while it stays in the cache.
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

/// The place of a chunk, or of a message outside of chunks, and its content by the first pass.
struct StoredChunk {
  std::uint32_t part = 0;               // number of the file in the recording
  bool is_truncated = false;            // the file ends within the chunk
  std::uint64_t at = 0, size = 0;       // position and size in the file, bytes
  std::vector<std::uint16_t> channels;  // channels with messages in the chunk, ascending
  std::uint32_t end = 0;  // one more than the index in the chunk of the last message to take
  /// Messages before `end` to skip, by their index in the chunk, ascending. They are damaged, or
  /// taken from another file of the recording.
  std::vector<std::uint32_t> left_out;
};

/// A message of an opened chunk. `data` points into the chunk's bytes.
struct ChunkMessage {
  std::uint16_t channel = 0;
  std::uint64_t log_time = 0;  // ns
  std::string_view data;
};

/// A chunk that was read and unpacked. Passes share it and keep it alive while they use it.
struct OpenedChunk {
  std::string bytes;                   // holds the data of `messages`
  std::vector<ChunkMessage> messages;  // without those left out, in their order

  std::size_t memory() const {
    return bytes.capacity() + messages.capacity() * sizeof(messages[0]);
  }
};

/// Safe to use from several threads at once. One lock covers files and cache. An InputFile of each
/// part stays open. The cache holds the chunks opened last, at most `most_cached` bytes but
/// always one chunk.
class StoredChunks {
 public:
  /// Limit on the memory of the cache, bytes. A lab of seven devices fills it in about 280 s. align
  /// reads its streams within two slabs of each other, at most 240 s (align/slabs.h).
  static constexpr std::size_t most_cached = std::size_t{64} << 20;

  struct File {
    std::string path;
    std::optional<FileVersion> version;  // version when the file was indexed
  };
  /// `files` must outlive the chunks.
  StoredChunks(FileSystem& files, std::vector<File> parts, std::vector<StoredChunk> chunks);

  std::size_t size() const { return chunks_.size(); }
  std::uint64_t bytes() const { return bytes_; }  // of all chunks in the files
  const StoredChunk& operator[](std::size_t k) const { return chunks_[k]; }
  /// Fails if the file has changed since it was indexed.
  Result<std::shared_ptr<const OpenedChunk>> open(std::size_t k) const;

 private:
  Result<std::shared_ptr<const OpenedChunk>> read(const StoredChunk& chunk) const;

  FileSystem* files_;
  std::vector<File> parts_;
  std::vector<StoredChunk> chunks_;
  std::uint64_t bytes_ = 0;
  mutable std::mutex mutex_;
  mutable std::vector<std::optional<InputFile>> open_files_;  // by part
  // opened chunks by their index, in the order of opening
  mutable std::deque<std::pair<std::size_t, std::shared_ptr<const OpenedChunk>>> cache_;
  mutable std::size_t cached_bytes_ = 0;
};

/// One pass over the messages of some channels, in the order of the files. A chunk is opened when
/// the pass needs it and is not kept.
class MessagePass {
 public:
  MessagePass(std::shared_ptr<const StoredChunks> chunks, std::vector<std::uint16_t> channels);

  using Take = std::function<Result<void>(const ChunkMessage&)>;
  /// Passes on the messages of the next chunk that has any. False after the last one.
  Result<bool> next_chunk(const Take& take);
  /// Bytes of the chunks that the pass has read, and of all chunks.
  std::uint64_t done() const { return done_; }
  std::uint64_t all() const { return chunks_->bytes(); }

 private:
  std::shared_ptr<const StoredChunks> chunks_;
  std::vector<std::uint16_t> channels_;  // ascending
  std::size_t next_ = 0;
  std::uint64_t done_ = 0;
};

}  // namespace kinalign
