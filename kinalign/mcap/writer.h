// SPDX-License-Identifier: Apache-2.0
// An MCAP file from front to end, in appends that each leave a file that can be read up to there.
// What it keeps in memory grows with the channels, not with the length: the index of chunks is put
// into the file by the page (a private record, which readers skip) and copied to the summary.
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

/// Where the bytes go. `append` takes all or, where it fails, nothing.
struct McapStore {
  std::function<Result<void>(std::string_view bytes)> append;
  /// Fills `to` with what was appended at `at`.
  std::function<Result<void>(std::uint64_t at, std::span<char> to)> read;
};

class McapWriter {
 public:
  explicit McapWriter(McapStore store) : store_(std::move(store)) {}

  /// First.
  Result<void> begin(const McapHeader& header);
  Result<void> write(const McapStoredChunk& chunk);
  Result<void> write(const McapAttachment& attachment);
  Result<void> write(const McapMetadata& metadata);
  /// Summary and end. Where it fails the writer is of no more use, and the file is to be cut back
  /// to the size before.
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
  std::uint64_t size_ = 0;
  std::uint32_t crc_ = 0;  // of all bytes so far
  McapDefinitions definitions_;
  McapStatistics statistics_;
  struct Page {
    std::uint64_t at = 0, size = 0;  // of its content
  };
  std::vector<Page> pages_;
  std::string chunk_indexes_;  // records that are in no page yet
  std::vector<McapAttachmentIndex> attachments_;
  std::vector<McapMetadataIndex> metadata_;
};

}  // namespace kinalign
