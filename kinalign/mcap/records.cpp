// SPDX-License-Identifier: Apache-2.0
#include "kinalign/mcap/records.h"

#include "kinalign/core/crc.h"
#include "kinalign/wire/little_endian_reader.h"

#include <type_traits>

namespace kinalign {

namespace {

// Reading.

// A truncated field reads as zeros. Callers ask complete() after the last field.
std::string text(LittleEndianReader& from) {
  return std::string(text_of(from.take_bytes(from.take<std::uint32_t>())));
}

template <std::unsigned_integral T>
void take(LittleEndianReader& from, T& value) {
  value = from.take<T>();
}
void take(LittleEndianReader& from, std::string& value) { value = text(from); }
void take(LittleEndianReader& from, std::string_view& value) {
  value = text_of(from.take_bytes(from.take<std::uint32_t>()));
}

/// Reads the entries of a map or an array, whose length is given in bytes.
template <class Take>
void entries(LittleEndianReader& from, Take one) {
  LittleEndianReader inner(from.take_bytes(from.take<std::uint32_t>()));
  while (inner.complete() && inner.left() > 0) one(inner);
  // a truncated entry makes the whole record invalid
  if (!inner.complete()) from.take_bytes(UINT64_MAX);
}
void take(LittleEndianReader& from, McapTexts& texts) {
  entries(from, [&](LittleEndianReader& one) {
    std::string key = text(one);
    texts.insert_or_assign(std::move(key), text(one));
  });
}
void take(LittleEndianReader& from, std::map<std::uint16_t, std::uint64_t>& numbers) {
  // A repeated key keeps its last value.
  entries(from, [&](LittleEndianReader& one) {
    const auto key = one.take<std::uint16_t>();
    numbers.insert_or_assign(key, one.take<std::uint64_t>());
  });
}
void take(LittleEndianReader& from, McapOp& op) {
  op = static_cast<McapOp>(from.take<std::uint8_t>());
}

// Writing.

void put(std::string& out, std::string_view text) {
  append_little(static_cast<std::uint32_t>(text.size()), out);
  out += text;
}
template <std::unsigned_integral T>
void put(std::string& out, T value) {
  append_little(value, out);
}
template <class Key, class Value>
void put(std::string& out, const std::map<Key, Value>& entries) {
  const std::size_t at = out.size();
  append_little(std::uint32_t{0}, out);
  for (const auto& [key, value] : entries) {
    put(out, key);
    put(out, value);
  }
  // The length of the map in bytes is known only now. It does not count its own four bytes.
  put_little(static_cast<std::uint32_t>(out.size() - at - 4), out.data() + at);
}
void put(std::string& out, McapOp op) { out += static_cast<char>(op); }

/// The fields of each record, in the order of their bytes. Reading and writing share this list.
/// One list can't drift apart in reading and writing. The order of the fields is that of the
/// specification.
template <class Record, class Visit>
void fields(Record& r, Visit visit) {
  using T = std::remove_const_t<Record>;
  if constexpr (std::is_same_v<T, McapHeader>) {
    visit(r.profile, r.library);
  } else if constexpr (std::is_same_v<T, McapSchema>) {
    visit(r.id, r.name, r.encoding, r.data);
  } else if constexpr (std::is_same_v<T, McapChannel>) {
    visit(r.id, r.schema_id, r.topic, r.message_encoding, r.metadata);
  } else if constexpr (std::is_same_v<T, McapMetadata>) {
    visit(r.name, r.texts);
  } else if constexpr (std::is_same_v<T, McapChunkHead>) {
    visit(r.start, r.end, r.uncompressed_size, r.uncompressed_crc, r.compression);
  } else if constexpr (std::is_same_v<T, McapChunkIndex>) {
    visit(r.start, r.end, r.chunk_offset, r.chunk_length, r.message_index_offsets,
          r.message_index_length, r.compression, r.compressed_size, r.uncompressed_size);
  } else if constexpr (std::is_same_v<T, McapAttachmentIndex>) {
    visit(r.offset, r.length, r.log_time, r.create_time, r.data_size, r.name, r.media_type);
  } else if constexpr (std::is_same_v<T, McapMetadataIndex>) {
    visit(r.offset, r.length, r.name);
  } else if constexpr (std::is_same_v<T, McapStatistics>) {
    visit(r.messages, r.schemas, r.channels, r.attachments, r.metadata, r.chunks, r.start, r.end,
          r.channel_messages);
  } else if constexpr (std::is_same_v<T, McapSummaryOffset>) {
    visit(r.group, r.start, r.length);
  } else if constexpr (std::is_same_v<T, McapDataEnd>) {
    visit(r.data_crc);
  } else {
    static_assert(std::is_same_v<T, McapFooter>);
    visit(r.summary_start, r.summary_offset_start, r.summary_crc);
  }
}

template <class Record>
std::optional<McapRecord> decoded(std::string_view content) {
  LittleEndianReader from(octets(content));
  Record record;
  // Bytes after the known fields are allowed, so only missing ones are an error.
  fields(record, [&](auto&... field) { (take(from, field), ...); });
  if (!from.complete()) return std::nullopt;
  return record;
}

std::optional<McapRecord> message(std::string_view content) {
  LittleEndianReader from(octets(content));
  McapMessage message;
  message.channel = from.take<std::uint16_t>();
  message.sequence = from.take<std::uint32_t>();
  message.log_time = from.take<std::uint64_t>();
  message.publish_time = from.take<std::uint64_t>();
  message.data = text_of(from.rest());
  if (!from.complete()) return std::nullopt;
  return message;
}

/// Absent also if the checksum is wrong.
std::optional<McapRecord> attachment(std::string_view content) {
  LittleEndianReader from(octets(content));
  McapAttachment attachment;
  take(from, attachment.log_time);
  take(from, attachment.create_time);
  take(from, attachment.name);
  take(from, attachment.media_type);
  attachment.data = text_of(from.take_bytes(from.take<std::uint64_t>()));
  // The checksum covers all fields before it.
  const std::string_view covered = content.substr(0, content.size() - from.left());
  const auto crc = from.take<std::uint32_t>();
  if (!from.complete() || (crc != 0 && crc != crc_of(covered))) return std::nullopt;
  return attachment;
}

/// Writes opcode and length before the bytes that `content` appends.
/// The length is filled in afterwards, so the content is written once and not measured first.
template <class Content>
void record(std::string& out, McapOp op, Content content) {
  const std::size_t at = out.size();
  out += static_cast<char>(op);
  append_little(std::uint64_t{0}, out);
  content();
  put_little(static_cast<std::uint64_t>(out.size() - at - mcap_record_head), out.data() + at + 1);
}

template <class Record>
void append_fields(std::string& out, McapOp op, const Record& from) {
  record(out, op, [&] { fields(from, [&](const auto&... field) { (put(out, field), ...); }); });
}

}  // namespace

std::optional<McapRecord> decode_mcap_record(McapOp op, std::string_view content) {
  switch (op) {
    case McapOp::header:
      return decoded<McapHeader>(content);
    case McapOp::footer:
      return decoded<McapFooter>(content);
    case McapOp::schema:
      return decoded<McapSchema>(content);
    case McapOp::channel:
      return decoded<McapChannel>(content);
    case McapOp::message:
      return message(content);
    case McapOp::chunk_index:
      return decoded<McapChunkIndex>(content);
    case McapOp::attachment:
      return attachment(content);
    case McapOp::attachment_index:
      return decoded<McapAttachmentIndex>(content);
    case McapOp::statistics:
      return decoded<McapStatistics>(content);
    case McapOp::metadata:
      return decoded<McapMetadata>(content);
    case McapOp::metadata_index:
      return decoded<McapMetadataIndex>(content);
    case McapOp::summary_offset:
      return decoded<McapSummaryOffset>(content);
    case McapOp::data_end:
      return decoded<McapDataEnd>(content);
    case McapOp::chunk:
    case McapOp::message_index:
    case McapOp::index_page:
      break;
  }
  return std::nullopt;
}

std::optional<McapRecordHead> decode_mcap_head(std::string_view bytes) {
  // An unknown opcode is a valid value of the enumeration, because its type is fixed.
  LittleEndianReader from(octets(bytes));
  const auto op = static_cast<McapOp>(from.take<std::uint8_t>());
  const auto length = from.take<std::uint64_t>();
  return from.complete() ? std::optional(McapRecordHead{op, length}) : std::nullopt;
}

std::optional<McapChunkView> decode_mcap_chunk(std::string_view content) {
  LittleEndianReader from(octets(content));
  McapChunkView chunk;
  fields(chunk.head, [&](auto&... field) { (take(from, field), ...); });
  take(from, chunk.stored_size);
  // substr() cuts at the end of the bytes; whole() shows whether it did.
  chunk.stored = text_of(from.rest()).substr(0, chunk.stored_size);
  if (!from.complete()) return std::nullopt;
  return chunk;
}

void append_mcap(std::string& out, const McapHeader& header) {
  append_fields(out, McapOp::header, header);
}
void append_mcap(std::string& out, const McapSchema& schema) {
  append_fields(out, McapOp::schema, schema);
}
void append_mcap(std::string& out, const McapChannel& channel) {
  append_fields(out, McapOp::channel, channel);
}
void append_mcap(std::string& out, const McapMetadata& metadata) {
  append_fields(out, McapOp::metadata, metadata);
}
void append_mcap(std::string& out, const McapChunkIndex& index) {
  append_fields(out, McapOp::chunk_index, index);
}
void append_mcap(std::string& out, const McapAttachmentIndex& index) {
  append_fields(out, McapOp::attachment_index, index);
}
void append_mcap(std::string& out, const McapMetadataIndex& index) {
  append_fields(out, McapOp::metadata_index, index);
}
void append_mcap(std::string& out, const McapStatistics& statistics) {
  append_fields(out, McapOp::statistics, statistics);
}
void append_mcap(std::string& out, const McapSummaryOffset& offset) {
  append_fields(out, McapOp::summary_offset, offset);
}
void append_mcap(std::string& out, const McapDataEnd& end) {
  append_fields(out, McapOp::data_end, end);
}
void append_mcap(std::string& out, const McapFooter& footer) {
  append_fields(out, McapOp::footer, footer);
}

void append_mcap(std::string& out, const McapMessage& message) {
  constexpr std::size_t head = mcap_record_head + 2 + 4 + 8 + 8;
  const std::size_t at = out.size();
  out.resize(at + head);  // one resize, since recorders call this function most
  char* to = out.data() + at;
  to[0] = static_cast<char>(McapOp::message);
  put_little(static_cast<std::uint64_t>(head - mcap_record_head + message.data.size()), to + 1);
  put_little(message.channel, to + 9);
  put_little(message.sequence, to + 11);
  put_little(message.log_time, to + 15);
  put_little(message.publish_time, to + 23);
  out += message.data;
}

void append_mcap(std::string& out, const McapAttachment& attachment) {
  // The checksum needs the position of the first field.
  record(out, McapOp::attachment, [&] {
    const std::size_t at = out.size();
    put(out, attachment.log_time);
    put(out, attachment.create_time);
    put(out, attachment.name);
    put(out, attachment.media_type);
    append_little(static_cast<std::uint64_t>(attachment.data.size()), out);
    out += attachment.data;
    append_little(crc_of(std::string_view(out).substr(at)), out);
  });
}

void append_mcap(std::string& out, const McapChunkHead& head, std::string_view stored) {
  record(out, McapOp::chunk, [&] {
    fields(head, [&](const auto&... field) { (put(out, field), ...); });
    append_little(static_cast<std::uint64_t>(stored.size()), out);
    out += stored;
  });
}

void append_mcap_message_index(std::string& out, std::uint16_t channel,
                               const std::vector<McapMessageEntry>& entries) {
  record(out, McapOp::message_index, [&] {
    append_little(channel, out);
    // 16 bytes an entry: the log time and the offset.
    append_little(static_cast<std::uint32_t>(16 * entries.size()), out);
    for (const McapMessageEntry& entry : entries) {
      append_little(entry.log_time, out);
      append_little(entry.offset, out);
    }
  });
}

void append_mcap_record(std::string& out, McapOp op, std::string_view content) {
  record(out, op, [&] { out += content; });
}

}  // namespace kinalign
