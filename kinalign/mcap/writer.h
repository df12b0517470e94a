// SPDX-License-Identifier: Apache-2.0
// Writes an MCAP file from beginning to end. After each append the file can be read up to there.
// The memory grows with the number of channels, not with the length: the index of the chunks is
// written into the file in pages (private records, which readers skip), and copied to the summary
// at the end.
// Each page costs 16 bytes of memory more.
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

/// Order of calls: begin() once, write() any number of times, finish() once. A write() that fails
/// leaves the writer as before, so it may be tried again.
class McapWriter {
 public:
  explicit McapWriter(McapStore store) : store_(std::move(store)) {}

  /// Call first.
  Result<void> begin(const McapHeader& header);
  Result<void> write(const McapStoredChunk& chunk);
  Result<void> write(const McapAttachment& attachment);
  Result<void> write(const McapMetadata& metadata);
  /// Writes the summary and the end. If it fails, the writer must not be used again, and the file
  /// must be cut back to its size before the call.
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
  // size_ is the file's size so far: where the next record begins. All bytes up to there are in
  // crc_.
  std::uint64_t size_ = 0;
  std::uint32_t crc_ = 0;  // of all bytes so far
  McapDefinitions definitions_;
  McapStatistics statistics_;
  struct Page {
    std::uint64_t at = 0, size = 0;  // of the page's content
  };
  // The index of a chunk is in exactly one place: chunk_indexes_, or one of the pages_.
  std::vector<Page> pages_;
  std::string chunk_indexes_;  // records that are not in a page yet
  std::vector<McapAttachmentIndex> attachments_;
  std::vector<McapMetadataIndex> metadata_;
};

}  // namespace kinalign
