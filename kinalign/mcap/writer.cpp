// SPDX-License-Identifier: Apache-2.0
#include "kinalign/mcap/writer.h"

#include "kinalign/core/crc.h"
#include "kinalign/wire/little_endian_reader.h"

#include <algorithm>

namespace kinalign {

namespace {

// A page of chunk indexes is written when it has this many bytes.
constexpr std::size_t page_size = std::size_t{64} << 10;

}  // namespace

/// The state while the summary is written: its groups of records, their positions, and the
/// checksum.
struct McapWriter::Summary {
  std::uint64_t start = 0;
  std::uint32_t crc = 0;
  std::vector<McapSummaryOffset> offsets{};
};

Result<void> McapWriter::append(std::string_view bytes) {
  // If the store fails, the writer stays unchanged.
  KA_TRY(store_.append(bytes));
  size_ += bytes.size();
  crc_ = crc_of(bytes, crc_);
  return {};
}

Result<void> McapWriter::begin(const McapHeader& header) {
  std::string bytes(mcap_magic);
  append_mcap(bytes, header);
  return append(bytes);
}

Result<void> McapWriter::write(const McapStoredChunk& chunk) {
  // Positions in the chunk's index count from the chunk. The position of the chunk in the file is
  // added.
  McapChunkIndex index = chunk.index;
  index.chunk_offset += size_;
  for (auto& [channel, offset] : index.message_index_offsets) offset += size_;
  KA_TRY(store_.append(chunk.bytes));
  size_ += chunk.bytes.size();
  // store() has computed the chunk's checksum in another thread.
  crc_ = joined_crc(crc_, chunk.crc, chunk.bytes.size());

  append_mcap(chunk_indexes_, index);
  // A chunk without messages has no times, so it must not change the first and last time of the
  // file.
  std::uint64_t messages = 0;
  for (const auto& [channel, count] : chunk.channel_messages) {
    statistics_.channel_messages[channel] += count;
    messages += count;
  }
  if (messages > 0) {
    const bool first = statistics_.messages == 0;
    statistics_.start = first ? index.start : std::min(statistics_.start, index.start);
    statistics_.end = std::max(statistics_.end, index.end);
    statistics_.messages += messages;
  }
  ++statistics_.chunks;
  // The summary contains the definitions of all chunks, each definition once.
  for (const auto& [id, schema] : chunk.definitions.schemas) {
    definitions_.schemas.insert_or_assign(id, schema);
  }
  for (const auto& [id, channel] : chunk.definitions.channels) {
    definitions_.channels.insert_or_assign(id, channel);
  }
  // The chunk is written already. If the page can't be written, its records stay in memory and the
  // next call tries again.
  if (chunk_indexes_.size() >= page_size) (void)write_index_page();
  return {};
}

Result<void> McapWriter::write_index_page() {
  std::string bytes;
  append_mcap_record(bytes, McapOp::index_page, chunk_indexes_);
  KA_TRY(append(bytes));
  // The page's content begins after the head of the record.
  pages_.push_back({size_ - chunk_indexes_.size(), chunk_indexes_.size()});
  chunk_indexes_.clear();
  return {};
}

Result<void> McapWriter::write(const McapAttachment& attachment) {
  std::string bytes;
  append_mcap(bytes, attachment);
  const std::uint64_t at = size_;
  KA_TRY(append(bytes));
  attachments_.push_back({at, bytes.size(), attachment.log_time, attachment.create_time,
                          attachment.data.size(), attachment.name, attachment.media_type});
  ++statistics_.attachments;
  return {};
}

Result<void> McapWriter::write(const McapMetadata& metadata) {
  std::string bytes;
  append_mcap(bytes, metadata);
  const std::uint64_t at = size_;
  KA_TRY(append(bytes));
  metadata_.push_back({at, bytes.size(), metadata.name});
  ++statistics_.metadata;
  return {};
}

// Writes all groups of the summary except the chunk indexes, and stores the position of each group.
// A group consists of all records of one opcode. An empty group gets no summary offset.
Result<void> McapWriter::write_definitions(Summary& summary) {
  const auto group = [&](McapOp op, const auto& put) -> Result<void> {
    std::string bytes;
    put(bytes);
    if (bytes.empty()) return {};
    summary.offsets.push_back({op, size_, bytes.size()});
    summary.crc = crc_of(bytes, summary.crc);
    return append(bytes);
  };
  statistics_.schemas = static_cast<std::uint16_t>(definitions_.schemas.size());
  statistics_.channels = static_cast<std::uint32_t>(definitions_.channels.size());
  KA_TRY(group(McapOp::schema, [&](std::string& out) {
    for (const auto& [id, schema] : definitions_.schemas) append_mcap(out, schema);
  }));
  KA_TRY(group(McapOp::channel, [&](std::string& out) {
    for (const auto& [id, channel] : definitions_.channels) append_mcap(out, channel);
  }));
  KA_TRY(group(McapOp::statistics, [&](std::string& out) { append_mcap(out, statistics_); }));
  // By the specification the records of a group stand together, and the order of groups is free.
  KA_TRY(group(McapOp::attachment_index, [&](std::string& out) {
    for (const McapAttachmentIndex& index : attachments_) append_mcap(out, index);
  }));
  return group(McapOp::metadata_index, [&](std::string& out) {
    for (const McapMetadataIndex& index : metadata_) append_mcap(out, index);
  });
}

// The pages are read from the file again, so the whole index need not fit into memory.
Result<void> McapWriter::write_chunk_indexes(Summary& summary) {
  const std::uint64_t at = size_;
  std::string bytes;
  for (const Page& page : pages_) {
    bytes.resize(page.size);
    KA_TRY(store_.read(page.at, bytes));
    summary.crc = crc_of(bytes, summary.crc);
    KA_TRY(append(bytes));
  }
  summary.crc = crc_of(chunk_indexes_, summary.crc);
  KA_TRY(append(chunk_indexes_));
  if (size_ > at) summary.offsets.push_back({McapOp::chunk_index, at, size_ - at});
  return {};
}

// The specification requires this order: data end, summary, summary offsets, footer, magic.
Result<void> McapWriter::finish() {
  std::string bytes;
  append_mcap(bytes, McapDataEnd{crc_});
  KA_TRY(append(bytes));

  Summary summary{size_};
  KA_TRY(write_definitions(summary));
  KA_TRY(write_chunk_indexes(summary));
  // The summary offsets begin at the current end of the file.
  McapFooter footer{summary.start, size_, 0};
  bytes.clear();
  for (const McapSummaryOffset& offset : summary.offsets) append_mcap(bytes, offset);
  append_mcap(bytes, footer);
  // The checksum covers the bytes of the footer before the checksum.
  const std::string_view covered = std::string_view(bytes).substr(0, bytes.size() - 4);
  footer.summary_crc = crc_of(covered, summary.crc);
  put_little(footer.summary_crc, bytes.data() + covered.size());
  // A reader recognises a complete file by the magic at the end.
  bytes += mcap_magic;
  return append(bytes);
}

}  // namespace kinalign
