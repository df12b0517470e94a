// SPDX-License-Identifier: Apache-2.0
#include "kinalign/mcap/records.h"

#include "kinalign/core/crc.h"
#include "kinalign/wire/little_endian_reader.h"

#include <concepts>
#include <map>
#include <type_traits>

namespace kinalign {

namespace {

// Functions for reading.

// Fields that are cut off read as zeros. Callers check complete() after the last field.
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

/// Reads the entries of a map or an array. Its length in bytes stands before the entries.
template <class Take>
void entries(LittleEndianReader& from, Take one) {
  LittleEndianReader inner(from.take_bytes(from.take<std::uint32_t>()));
  while (inner.complete() && inner.left() > 0) one(inner);
  // If an entry is cut off, this makes the whole record incomplete.
  if (!inner.complete()) from.take_bytes(UINT64_MAX);
}
void take(LittleEndianReader& from, McapTexts& texts) {
  entries(from, [&](LittleEndianReader& one) {
    std::string key = text(one);
    texts.insert_or_assign(std::move(key), text(one));
  });
}
void take(LittleEndianReader& from, std::map<std::uint16_t, std::uint64_t>& numbers) {
  // If a key is repeated, its last value is kept.
  entries(from, [&](LittleEndianReader& one) {
    const auto key = one.take<std::uint16_t>();
    numbers.insert_or_assign(key, one.take<std::uint64_t>());
  });
}
void take(LittleEndianReader& from, McapOp& op) {
  op = static_cast<McapOp>(from.take<std::uint8_t>());
}

// Functions for writing.

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
  // The length of the map in bytes is known now. It does not include its own four bytes.
  put_little(static_cast<std::uint32_t>(out.size() - at - 4), out.data() + at);
}
void put(std::string& out, McapOp op) { out += static_cast<char>(op); }

/// Reads all fields of a record.
template <class Record>
void take_fields(LittleEndianReader& from, Record& record) {
  std::apply([&](auto&... field) { (take(from, field), ...); }, Record::fields(record));
}
template <class Record>
void put_fields(std::string& out, const Record& record) {
  std::apply([&](const auto&... field) { (put(out, field), ...); }, Record::fields(record));
}

template <class Record>
std::optional<McapRecord> decoded(std::string_view content, std::size_t& surplus) {
  LittleEndianReader from(octets(content));
  Record record;
  // Bytes after the known fields are allowed. Only missing fields are an error.
  take_fields(from, record);
  surplus = from.left();
  if constexpr (std::is_same_v<Record, McapMessage>) {
    record.data = text_of(from.rest());
    surplus = 0;
  }
  if (!from.complete()) return std::nullopt;
  return record;
}

/// Decodes an attachment. The result is empty also if the checksum is wrong.
template <>
std::optional<McapRecord> decoded<McapAttachment>(std::string_view content, std::size_t& surplus) {
  LittleEndianReader from(octets(content));
  McapAttachment attachment;
  take_fields(from, attachment);
  attachment.data = text_of(from.take_bytes(from.take<std::uint64_t>()));
  // The checksum covers all fields in front of it.
  const std::string_view covered = content.substr(0, content.size() - from.left());
  const auto crc = from.take<std::uint32_t>();
  surplus = from.left();
  if (!from.complete() || (crc != 0 && crc != crc_of(covered))) return std::nullopt;
  return attachment;
}

/// Writes opcode and length, then the bytes that `content` appends. The length is filled in
/// afterwards, so the content need not be measured first.
template <class Content>
void record(std::string& out, McapOp op, Content content) {
  const std::size_t at = out.size();
  out += static_cast<char>(op);
  append_little(std::uint64_t{0}, out);
  content();
  put_little(static_cast<std::uint64_t>(out.size() - at - mcap_record_head), out.data() + at + 1);
}

/// Decodes the type of record in the variant that has this opcode.
template <class... Records>
std::optional<McapRecord> decoded_as(McapOp op, std::string_view content, std::size_t& surplus,
                                     const std::variant<Records...>*) {
  std::optional<McapRecord> record;
  ((Records::op == op ? void(record = decoded<Records>(content, surplus)) : void()), ...);
  return record;
}

}  // namespace

std::optional<McapRecord> decode_mcap_record(McapOp op, std::string_view content,
                                             std::size_t* surplus) {
  std::size_t unused = 0;
  return decoded_as(op, content, surplus != nullptr ? *surplus : unused,
                    static_cast<const McapRecord*>(nullptr));
}

std::optional<McapRecordHead> decode_mcap_head(std::string_view bytes) {
  // The enumeration has a fixed type, so an unknown opcode is a valid value.
  LittleEndianReader from(octets(bytes));
  const auto op = static_cast<McapOp>(from.take<std::uint8_t>());
  const auto length = from.take<std::uint64_t>();
  return from.complete() ? std::optional(McapRecordHead{op, length}) : std::nullopt;
}

std::optional<McapChunkView> decode_mcap_chunk(std::string_view content) {
  LittleEndianReader from(octets(content));
  McapChunkView chunk;
  take_fields(from, chunk.head);
  take(from, chunk.stored_size);
  // substr() stops at the end of the bytes. whole() shows whether bytes are missing.
  chunk.stored = text_of(from.rest()).substr(0, chunk.stored_size);
  if (!from.complete()) return std::nullopt;
  return chunk;
}

template <class Record>
void append_mcap(std::string& out, const Record& from) {
  record(out, Record::op, [&] { put_fields(out, from); });
}
template void append_mcap(std::string&, const McapHeader&);
template void append_mcap(std::string&, const McapSchema&);
template void append_mcap(std::string&, const McapChannel&);
template void append_mcap(std::string&, const McapMetadata&);
template void append_mcap(std::string&, const McapChunkIndex&);
template void append_mcap(std::string&, const McapAttachmentIndex&);
template void append_mcap(std::string&, const McapMetadataIndex&);
template void append_mcap(std::string&, const McapStatistics&);
template void append_mcap(std::string&, const McapSummaryOffset&);
template void append_mcap(std::string&, const McapDataEnd&);
template void append_mcap(std::string&, const McapFooter&);

void append_mcap(std::string& out, const McapMessage& message) {
  constexpr std::size_t head = mcap_record_head + 2 + 4 + 8 + 8;
  const std::size_t at = out.size();
  out.resize(at + head);  // one resize, because recorders call this function most often
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
  // The checksum begins at the first field, so its position is kept.
  record(out, McapOp::attachment, [&] {
    const std::size_t at = out.size();
    put_fields(out, attachment);
    append_little(static_cast<std::uint64_t>(attachment.data.size()), out);
    out += attachment.data;
    append_little(crc_of(std::string_view(out).substr(at)), out);
  });
}

void append_mcap(std::string& out, const McapChunkHead& head, std::string_view stored) {
  record(out, McapOp::chunk, [&] {
    put_fields(out, head);
    append_little(static_cast<std::uint64_t>(stored.size()), out);
    out += stored;
  });
}

void append_mcap_message_index(std::string& out, std::uint16_t channel,
                               const std::vector<McapMessageEntry>& entries) {
  record(out, McapOp::message_index, [&] {
    append_little(channel, out);
    // An entry has 16 bytes: the log time and the offset.
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
