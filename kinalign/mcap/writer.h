// SPDX-License-Identifier: Apache-2.0
// Writes an MCAP file from beginning to end. After each append the file can be read up to its end.
// The memory depends on the number of channels and hardly on the file's length. The index of the
// chunks is written into the file in pages, which are private records that readers skip. At the end
// the pages are copied to the summary. Each page needs 16 bytes of memory.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/mcap/chunk.h"
#include "kinalign/mcap/records.h"

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// The destination of the bytes. `append` writes all bytes or, if it fails, none.
struct McapStore {
  std::function<Result<void>(std::string_view bytes)> append;
  /// Fills `to` with the bytes at position `at`.
  std::function<Result<void>(std::uint64_t at, std::span<char> to)> read;
};

/// Call begin() once, then write() any number of times, then finish() once. A write() that fails
/// leaves the writer unchanged, so the call may be repeated.
class McapWriter {
 public:
  explicit McapWriter(McapStore store) : store_(std::move(store)) {}

  /// Call this first.
  Result<void> begin(const McapHeader& header);
  Result<void> write(const McapStoredChunk& chunk);
  Result<void> write(const McapAttachment& attachment);
  Result<void> write(const McapMetadata& metadata);
  /// Writes the summary and the end of the file. If this fails, the writer must not be used again.
  /// The caller must then cut the file back to its size before the call.
  Result<void> finish();

  std::uint64_t size() const { return size_; }
  std::uint64_t messages() const { return statistics_.messages; }

 private:
  Result<void> append(std::string_view bytes);
  Result<void> write_index_page();
  struct Summary;
  Result<void> write_definitions(Summary& summary);
  Result<void> write_chunk_indexes(Summary& summary);

  McapStore store_;
  // size_ is the size of the file, where the next record begins. crc_ covers all bytes up to there.
  std::uint64_t size_ = 0;
  std::uint32_t crc_ = 0;  // checksum of all bytes so far
  McapDefinitions definitions_;
  McapStatistics statistics_;
  struct Page {
    std::uint64_t at = 0, size = 0;  // position and size of the page's content
  };
  // The index of each chunk is stored once: in chunk_indexes_ or in one of the pages_.
  std::vector<Page> pages_;
  std::string chunk_indexes_;  // records that no page contains yet
  std::vector<McapAttachmentIndex> attachments_;
  std::vector<McapMetadataIndex> metadata_;
};

}  // namespace kinalign
