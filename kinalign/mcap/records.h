// SPDX-License-Identifier: Apache-2.0
// The records of MCAP, converted from bytes to structures and back: https://mcap.dev/spec.
// docs/formats/recording.md repeats the part that recordings use. A record is an opcode, a length
// of 64 bits, and its content. Unknown opcodes are skipped, and so are bytes after the known
// fields.
// A length counts the content only, without the nine bytes of opcode and length.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <variant>
#include <vector>

namespace kinalign {

inline constexpr std::string_view mcap_magic = "\x89MCAP0\r\n";
inline constexpr std::size_t mcap_record_head = 9;  // opcode and length

enum class McapOp : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  attachment = 0x09,
  attachment_index = 0x0A,
  statistics = 0x0B,
  metadata = 0x0C,
  metadata_index = 0x0D,
  summary_offset = 0x0E,
  data_end = 0x0F,
  // private: chunk index records, stored in the file until the summary is written
  index_page = 0x81
};

// Each record states its opcode and its fields in the order of their bytes. Reading and writing
// share this list.

using McapTexts = std::map<std::string, std::string>;

struct McapHeader {
  static constexpr McapOp op = McapOp::header;
  std::string profile, library;
  static auto fields(auto& r) { return std::tie(r.profile, r.library); }
};

/// The description of the messages of a channel. Id 0 means no schema.
struct McapSchema {
  static constexpr McapOp op = McapOp::schema;
  std::uint16_t id = 0;
  std::string name, encoding, data;
  static auto fields(auto& r) { return std::tie(r.id, r.name, r.encoding, r.data); }

  bool operator==(const McapSchema&) const = default;
};

// Data of one sender share a channel. The channel names the topic and the encoding of its messages.
struct McapChannel {
  static constexpr McapOp op = McapOp::channel;
  std::uint16_t id = 0, schema_id = 0;
  std::string topic, message_encoding;
  McapTexts metadata;
  static auto fields(auto& r) {
    return std::tie(r.id, r.schema_id, r.topic, r.message_encoding, r.metadata);
  }

  bool operator==(const McapChannel&) const = default;
};

/// log_time: when the message was recorded. publish_time: when it was sent, or log_time if that is
/// not known (the specification).
struct McapMessage {
  static constexpr McapOp op = McapOp::message;
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0, publish_time = 0;  // ns
  std::string_view data;                         // bytes of the reader or of the caller
  /// Without the data, which ends the record.
  static auto fields(auto& r) {
    return std::tie(r.channel, r.sequence, r.log_time, r.publish_time);
  }
};

struct McapAttachment {
  static constexpr McapOp op = McapOp::attachment;
  std::uint64_t log_time = 0, create_time = 0;
  std::string name, media_type, data;
  /// Without the data and its checksum, which end the record.
  static auto fields(auto& r) { return std::tie(r.log_time, r.create_time, r.name, r.media_type); }
};

struct McapMetadata {
  static constexpr McapOp op = McapOp::metadata;
  std::string name;
  McapTexts texts;
  static auto fields(auto& r) { return std::tie(r.name, r.texts); }
};

/// The fields of a chunk before its records.
/// A chunk holds records as one block, compressed or not. Its checksum is that of the records
/// before compression.
struct McapChunkHead {
  static constexpr McapOp op = McapOp::chunk;
  std::uint64_t start = 0, end = 0;  // lowest and highest log time, ns
  std::uint64_t uncompressed_size = 0;
  std::uint32_t uncompressed_crc = 0;  // 0: not checked
  std::string_view compression;  // "", "zstd", "lz4"; for a chunk that was read, part of its bytes
  static auto fields(auto& r) {
    return std::tie(r.start, r.end, r.uncompressed_size, r.uncompressed_crc, r.compression);
  }
};

/// Tells a reader where a chunk is and which channels and times it holds. Offsets count from the
/// file's first byte.
struct McapChunkIndex {
  static constexpr McapOp op = McapOp::chunk_index;
  std::uint64_t start = 0, end = 0, chunk_offset = 0, chunk_length = 0;
  std::map<std::uint16_t, std::uint64_t> message_index_offsets;
  std::uint64_t message_index_length = 0;
  std::string compression;
  std::uint64_t compressed_size = 0, uncompressed_size = 0;
  static auto fields(auto& r) {
    return std::tie(r.start, r.end, r.chunk_offset, r.chunk_length, r.message_index_offsets,
                    r.message_index_length, r.compression, r.compressed_size, r.uncompressed_size);
  }
};

struct McapAttachmentIndex {
  static constexpr McapOp op = McapOp::attachment_index;
  std::uint64_t offset = 0, length = 0, log_time = 0, create_time = 0, data_size = 0;
  std::string name, media_type;
  static auto fields(auto& r) {
    return std::tie(r.offset, r.length, r.log_time, r.create_time, r.data_size, r.name,
                    r.media_type);
  }
};

struct McapMetadataIndex {
  static constexpr McapOp op = McapOp::metadata_index;
  std::uint64_t offset = 0, length = 0;
  std::string name;
  static auto fields(auto& r) { return std::tie(r.offset, r.length, r.name); }
};

struct McapStatistics {
  static constexpr McapOp op = McapOp::statistics;
  std::uint64_t messages = 0;
  std::uint16_t schemas = 0;
  std::uint32_t channels = 0, attachments = 0, metadata = 0, chunks = 0;
  std::uint64_t start = 0, end = 0;  // lowest and highest log time, ns
  std::map<std::uint16_t, std::uint64_t> channel_messages;
  static auto fields(auto& r) {
    return std::tie(r.messages, r.schemas, r.channels, r.attachments, r.metadata, r.chunks, r.start,
                    r.end, r.channel_messages);
  }
};

/// Tells where the summary holds the records of one opcode.
struct McapSummaryOffset {
  static constexpr McapOp op = McapOp::summary_offset;
  McapOp group{};
  std::uint64_t start = 0, length = 0;
  static auto fields(auto& r) { return std::tie(r.group, r.start, r.length); }
};

struct McapDataEnd {
  static constexpr McapOp op = McapOp::data_end;
  std::uint32_t data_crc = 0;  // 0: not checked
  static auto fields(auto& r) { return std::tie(r.data_crc); }
};

struct McapFooter {
  static constexpr McapOp op = McapOp::footer;
  std::uint64_t summary_start = 0, summary_offset_start = 0;  // 0: none
  std::uint32_t summary_crc = 0;                              // 0: not checked
  static auto fields(auto& r) {
    return std::tie(r.summary_start, r.summary_offset_start, r.summary_crc);
  }
};

/// The records that a reader returns. Chunks are replaced by their content.
using McapRecord =
    std::variant<McapHeader, McapSchema, McapChannel, McapMessage, McapAttachment, McapMetadata,
                 McapChunkIndex, McapAttachmentIndex, McapMetadataIndex, McapStatistics,
                 McapSummaryOffset, McapDataEnd, McapFooter>;

/// Decodes the content of a record. Absent if the fields do not fit, or if the opcode is not in the
/// variant (chunk, message index, index page, or unknown).
/// Text and bytes in the result are copies, except the data of a message.
std::optional<McapRecord> decode_mcap_record(McapOp op, std::string_view content);

/// The head of a chunk and its stored records. Of a truncated chunk, those that are present.
struct McapChunkView {
  McapChunkHead head;
  std::uint64_t stored_size = 0;
  std::string_view stored;

  /// Bytes of the content without the stored records and the compression's name.
  static constexpr std::size_t fields = 8 + 8 + 8 + 4 + 4 + 8;

  bool whole() const { return stored.size() == stored_size; }
  /// Bytes of the complete content.
  std::uint64_t size() const { return fields + head.compression.size() + stored_size; }
};
/// The beginning of a record.
struct McapRecordHead {
  McapOp op{};
  std::uint64_t length = 0;  // bytes of the content
};
/// Absent if `bytes` is shorter than a head.
std::optional<McapRecordHead> decode_mcap_head(std::string_view bytes);

/// Absent if the head is longer than `content`.
std::optional<McapChunkView> decode_mcap_chunk(std::string_view content);

/// Appends the complete record. `Record`: a record with a list of fields.
template <class Record>
void append_mcap(std::string& out, const Record& record);
void append_mcap(std::string& out, const McapMessage& message);
void append_mcap(std::string& out, const McapAttachment& attachment);
void append_mcap(std::string& out, const McapChunkHead& head, std::string_view stored);

/// The log time of a message, ns, and the offset of its record among the chunk's records.
struct McapMessageEntry {
  std::uint64_t log_time = 0, offset = 0;
};
void append_mcap_message_index(std::string& out, std::uint16_t channel,
                               const std::vector<McapMessageEntry>& entries);
/// Appends a record with any opcode and this content.
void append_mcap_record(std::string& out, McapOp op, std::string_view content);

}  // namespace kinalign
