// SPDX-License-Identifier: Apache-2.0
// Converts the records of MCAP between bytes and structures: https://mcap.dev/spec.
// docs/formats/recording.md describes the part that recordings use. A record consists of an opcode
// (8 bits), a length (64 bits) and its content. The length counts the content only. Readers skip
// unknown opcodes, and bytes after the known fields.
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
  // kinalign's own opcode: pages of chunk index records. They stay in the file until the summary is
  // written.
  index_page = 0x81
};

// Each record lists its opcode and its fields in the order of their bytes. The code for reading and
// writing uses the same list.

using McapTexts = std::map<std::string, std::string>;

struct McapHeader {
  static constexpr McapOp op = McapOp::header;
  std::string profile, library;
  static auto fields(auto& r) { return std::tie(r.profile, r.library); }
};

/// Describes the messages of a channel. The id 0 means that there is no schema.
struct McapSchema {
  static constexpr McapOp op = McapOp::schema;
  std::uint16_t id = 0;
  std::string name, encoding, data;
  static auto fields(auto& r) { return std::tie(r.id, r.name, r.encoding, r.data); }

  bool operator==(const McapSchema&) const = default;
};

// The messages of one sender on one topic, and their encoding.
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

/// log_time: when the message was recorded. publish_time: when the message was sent or, if this is
/// unknown, log_time, as the specification says.
struct McapMessage {
  static constexpr McapOp op = McapOp::message;
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0, publish_time = 0;  // ns
  std::string_view data;                         // a view of the reader's or caller's bytes
  /// The list does not include the data, which stand at the end of the record.
  static auto fields(auto& r) {
    return std::tie(r.channel, r.sequence, r.log_time, r.publish_time);
  }
};

struct McapAttachment {
  static constexpr McapOp op = McapOp::attachment;
  std::uint64_t log_time = 0, create_time = 0;
  std::string name, media_type, data;
  /// The list does not include the data and the checksum, which stand at the end of the record.
  static auto fields(auto& r) { return std::tie(r.log_time, r.create_time, r.name, r.media_type); }
};

struct McapMetadata {
  static constexpr McapOp op = McapOp::metadata;
  std::string name;
  McapTexts texts;
  static auto fields(auto& r) { return std::tie(r.name, r.texts); }
};

/// The fields of a chunk before its records. A chunk contains records as one block, compressed or
/// not. Its checksum covers the uncompressed records.
struct McapChunkHead {
  static constexpr McapOp op = McapOp::chunk;
  std::uint64_t start = 0, end = 0;  // lowest and highest log time, ns
  std::uint64_t uncompressed_size = 0;
  std::uint32_t uncompressed_crc = 0;  // 0: no checksum
  std::string_view compression;  // "", "zstd" or "lz4"; after reading, a view of the chunk's bytes
  static auto fields(auto& r) {
    return std::tie(r.start, r.end, r.uncompressed_size, r.uncompressed_crc, r.compression);
  }
};

/// Gives the position of a chunk, and its channels and times. Offsets count from the first byte of
/// the file.
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

/// Gives the position of all records of one opcode in the summary.
struct McapSummaryOffset {
  static constexpr McapOp op = McapOp::summary_offset;
  McapOp group{};
  std::uint64_t start = 0, length = 0;
  static auto fields(auto& r) { return std::tie(r.group, r.start, r.length); }
};

struct McapDataEnd {
  static constexpr McapOp op = McapOp::data_end;
  std::uint32_t data_crc = 0;  // 0: no checksum
  static auto fields(auto& r) { return std::tie(r.data_crc); }
};

struct McapFooter {
  static constexpr McapOp op = McapOp::footer;
  std::uint64_t summary_start = 0, summary_offset_start = 0;  // 0: absent
  std::uint32_t summary_crc = 0;                              // 0: no checksum
  static auto fields(auto& r) {
    return std::tie(r.summary_start, r.summary_offset_start, r.summary_crc);
  }
};

/// The records that a reader returns. It returns the content of a chunk instead of the chunk.
using McapRecord =
    std::variant<McapHeader, McapSchema, McapChannel, McapMessage, McapAttachment, McapMetadata,
                 McapChunkIndex, McapAttachmentIndex, McapMetadataIndex, McapStatistics,
                 McapSummaryOffset, McapDataEnd, McapFooter>;

/// Decodes the content of a record. The result is empty if the fields do not fit, or if the variant
/// does not include the opcode (chunk, message index, index page, or unknown). Texts and bytes in
/// the result are copies, except the data of a message. `surplus` gets the number of bytes after
/// the known fields.
std::optional<McapRecord> decode_mcap_record(McapOp op, std::string_view content,
                                             std::size_t* surplus = nullptr);

/// The head of a chunk and its stored records. If the chunk is truncated, only the present records.
struct McapChunkView {
  McapChunkHead head;
  std::uint64_t stored_size = 0;
  std::string_view stored;

  /// The bytes of a chunk's content without the stored records and without the name of the
  /// compression.
  static constexpr std::size_t fields = 8 + 8 + 8 + 4 + 4 + 8;

  bool whole() const { return stored.size() == stored_size; }
  /// The bytes of the content if it is complete.
  std::uint64_t size() const { return fields + head.compression.size() + stored_size; }
};
/// The opcode and the length of a record.
struct McapRecordHead {
  McapOp op{};
  std::uint64_t length = 0;  // bytes of the content
};
/// The result is empty if `bytes` is shorter than a head.
std::optional<McapRecordHead> decode_mcap_head(std::string_view bytes);

/// The result is empty if `content` is shorter than a chunk's head.
std::optional<McapChunkView> decode_mcap_chunk(std::string_view content);

/// Appends the complete record. `Record` must be a type with a list of fields.
template <class Record>
void append_mcap(std::string& out, const Record& record);
void append_mcap(std::string& out, const McapMessage& message);
void append_mcap(std::string& out, const McapAttachment& attachment);
void append_mcap(std::string& out, const McapChunkHead& head, std::string_view stored);

/// The log time of a message, ns, and the position of its record among the records of the chunk.
struct McapMessageEntry {
  std::uint64_t log_time = 0, offset = 0;
};
void append_mcap_message_index(std::string& out, std::uint16_t channel,
                               const std::vector<McapMessageEntry>& entries);
/// Appends a record with any opcode and this content.
void append_mcap_record(std::string& out, McapOp op, std::string_view content);

}  // namespace kinalign
