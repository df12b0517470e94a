// SPDX-License-Identifier: Apache-2.0
#include "kinalign/mcap/reader.h"

#include "kinalign/core/crc.h"
#include "kinalign/wire/little_endian_reader.h"

#include <algorithm>
#include <utility>

namespace kinalign {

namespace {

constexpr std::size_t most_findings = 200;

// The size of a chunk's head with the name "zstd", the longest name that find_chunk() accepts.
constexpr std::size_t longest_chunk_head = mcap_record_head + McapChunkView::fields + 4;

// Bytes that may follow the known fields of a record. Files that were seen have at most 3.
constexpr std::size_t most_surplus = 64;

/// Decodes the chunk at the beginning of `bytes` if its fields are plausible. Opcode and length in
/// front of a chunk have no checksum, so they count only if the chunk has none either. `most`: the
/// limit on the sizes of the chunk, bytes.
std::optional<McapChunkView> plausible_chunk(std::string_view bytes, std::uint64_t most) {
  constexpr std::size_t crc_at = mcap_record_head + 8 + 8 + 8, name_at = crc_at + 4;
  if (bytes.size() < mcap_record_head + McapChunkView::fields) return std::nullopt;
  // These tests take little time, and few positions pass them.
  const bool has_opcode = static_cast<McapOp>(bytes.front()) == McapOp::chunk;
  if (little_at<std::uint32_t>(octets(bytes), name_at) > 4) return std::nullopt;
  if (!has_opcode && little_at<std::uint32_t>(octets(bytes), crc_at) == 0) return std::nullopt;
  const auto chunk = decode_mcap_chunk(bytes.substr(mcap_record_head));
  if (!chunk) return std::nullopt;
  const McapChunkHead& head = chunk->head;
  const bool fits = chunk->stored_size <= most && head.uncompressed_size <= most;
  const bool has_head = has_opcode && decode_mcap_head(bytes)->length == chunk->size();
  const bool has_name = head.compression == "zstd" ||
                        (head.compression.empty() && head.uncompressed_size == chunk->stored_size);
  const bool has_fields = head.uncompressed_crc != 0 && head.uncompressed_size > 0 && has_name;
  return fits && (has_head || has_fields) ? chunk : std::nullopt;
}

}  // namespace

void McapReader::feed(std::string_view piece) {
  // In the states after after_footer the reader is finished and ignores further bytes.
  if (state_ > State::after_footer) return;
  buffer_.erase(0, taken_);
  taken_ = 0;
  buffer_ += piece;
}

void McapReader::consume(std::size_t size) {
  taken_ += size;
  offset_ += size;
}

void McapReader::skip(std::size_t size) {
  consume(size);
  skipped_ += size;
}

void McapReader::report(Severity severity, std::string expected, std::string found,
                        std::string meaning) {
  // The limit is needed, because a badly damaged file would give one finding for every few bytes.
  if (findings_.size() >= most_findings) return;
  found += " at byte " + std::to_string(offset_);
  findings_.push_back(
      {severity, {"", 0, std::move(expected), std::move(found)}, std::move(meaning), ""});
}

/// Reports that no valid record is at this position. Reading continues at the next chunk, which may
/// be at this position if only its opcode or length is damaged.
void McapReader::report_damage(std::string expected, std::string found) {
  report(Severity::error, std::move(expected), std::move(found),
         "what stands there is left out, up to the next whole chunk");
  state_ = State::lost;
  // The checksum of the section can't be compared any more, because bytes are skipped.
  crc_counts_ = false;
}

std::optional<McapRecord> McapReader::next() {
  // The records of the open chunk come before the records that follow the chunk in the file.
  if (auto record = next_in_chunk()) return record;
  return next_in_file();
}

std::optional<McapRecord> McapReader::next_in_chunk() {
  // Only the damaged record of a chunk is left out, because its length gives the position of the
  // next record.
  while (chunk_taken_ < chunk_.size()) {
    const std::string_view bytes = std::string_view(chunk_).substr(chunk_taken_);
    const auto head = decode_mcap_head(bytes);
    const bool whole = head && head->length <= bytes.size() - mcap_record_head;
    // A truncated chunk always ends within a record, so this is not reported.
    if (!whole && in_truncated_chunk_) break;
    std::optional<McapRecord> record;
    std::size_t surplus = 0;  // allowed, because the chunk's checksum covers the lengths
    const bool fits =
        whole && take(head->op, bytes.substr(mcap_record_head, head->length), record, surplus);
    const bool ends = !whole || head->op == McapOp{};  // a power failure may leave zeros
    if (!fits) {
      report(Severity::error, "valid records in the chunk", "a damaged record",
             ends ? "the rest of the chunk is skipped" : "the record is skipped");
    }
    if (!fits && ends) break;
    chunk_taken_ += mcap_record_head + head->length;
    // Records that readers do not need are skipped.
    if (record) return record;
  }
  chunk_.clear();
  chunk_taken_ = 0;
  return std::nullopt;
}

/// Decodes a record. Returns true if the content is valid. `record` stays empty if readers do not
/// need the record. `surplus`: the number of bytes after the known fields.
bool McapReader::take(McapOp op, std::string_view content, std::optional<McapRecord>& record,
                      std::size_t& surplus) {
  // kinalign does not use message indexes, but an invalid one shows that the file is damaged.
  if (op == McapOp::message_index) {
    LittleEndianReader from(octets(content));
    from.take<std::uint16_t>();
    from.take_bytes(from.take<std::uint32_t>());
    surplus = from.left();
    return from.complete();
  }
  // The specification lets readers skip opcodes that they don't know.
  if (op > McapOp::data_end) {
    surplus = content.size();
    return true;
  }
  record = decode_mcap_record(op, content, &surplus);
  // These two end a section of the file. Their length never differs, so surplus bytes show that
  // another record's opcode is damaged.
  const bool ends = op == McapOp::footer || op == McapOp::data_end;
  return record.has_value() && (surplus == 0 || !ends);
}

/// Checks the magic bytes at the beginning of the file.
void McapReader::start() {
  const std::string_view bytes = rest();
  // Fewer than eight bytes may be the beginning of the magic, so more bytes are needed.
  const std::size_t some = std::min(bytes.size(), mcap_magic.size());
  if (bytes.substr(0, some) != mcap_magic.substr(0, some) || (ended_ && some < mcap_magic.size())) {
    state_ = State::foreign;
    report(Severity::error, "an MCAP file", "another beginning", "nothing was read");
    return;
  }
  if (some < mcap_magic.size()) return;
  // The checksum of the data section includes the magic.
  crc_ = crc_of(mcap_magic, crc_);
  consume(mcap_magic.size());
  state_ = State::records;
}

/// Reads records of the file until one can be returned. Each branch makes progress or needs more
/// bytes.
std::optional<McapRecord> McapReader::next_in_file() {
  for (;;) {
    if (state_ == State::start) start();
    if (state_ == State::lost || state_ == State::surplus) find_chunk();
    if (state_ == State::after_footer) find_magic();
    if (state_ != State::records) return std::nullopt;
    switch (look()) {
      case Look::nothing:
        return std::nullopt;
      case Look::truncated:
        return next_in_chunk();
      case Look::damaged:
        continue;
      case Look::whole:
        break;
    }
    if (auto record = read_record()) return record;
  }
}

/// Examines the bytes at this position. Damage is reported and skipped. The cheap tests come first.
/// An impossible length is damage. A length beyond the present bytes means that more bytes may be
/// needed.
McapReader::Look McapReader::look() {
  if (found_size_ > 0) return Look::whole;
  const std::string_view bytes = rest();
  const auto head = decode_mcap_head(bytes);
  if (head && head->op == McapOp{}) {
    report_damage("a record", "a byte 0");
    return Look::damaged;
  }
  if (head && head->length > longest_) {
    report_damage("a record of at most " + std::to_string(longest_ >> 20) + " MiB",
                  std::to_string(head->length >> 20) + " MiB");
    return Look::damaged;
  }
  if (head && head->length <= bytes.size() - mcap_record_head) return Look::whole;
  // More bytes may arrive, or the file ends exactly here.
  if (!ended_ || bytes.empty()) return Look::nothing;
  end_in_record();
  return state_ == State::records ? Look::damaged : Look::truncated;
}

/// Reads the complete record at this position. The result is empty if readers do not need the
/// record, or if the record is damaged.
std::optional<McapRecord> McapReader::read_record() {
  // look() has checked that the record is complete.
  record_at_ = offset_;
  McapRecordHead head = *decode_mcap_head(rest());
  // The head of a chunk that find_chunk() found may be damaged.
  if (found_size_ > 0) head = {McapOp::chunk, std::exchange(found_size_, 0)};
  const std::string_view whole = rest().substr(0, mcap_record_head + head.length);
  record_size_ = whole.size();
  const std::string_view content = whole.substr(mcap_record_head);
  std::optional<McapRecord> record;
  std::size_t surplus = 0;
  const bool is_chunk = head.op == McapOp::chunk;
  const bool is_valid = is_chunk ? open_chunk(content) : take(head.op, content, record, surplus);
  if (!is_valid || (surplus > 0 && is_hidden_chunk(whole))) {
    report_damage("a record with valid fields and checksum", "a damaged record");
    return std::nullopt;
  }
  // No chunk's checksum covers this record; only the section's checksum does.
  if (!is_chunk) uncovered_ = true;
  if (is_chunk) record = next_in_chunk();
  // crc_ is updated last, because check_crc() needs the checksum of the bytes before this record.
  if (record) check_crc(*record, whole);
  crc_ = crc_of(whole, crc_);
  if (head.op == McapOp::data_end) {
    // The summary has its own checksum, which begins after this record.
    crc_ = 0;
    crc_counts_ = true;  // the summary's checksum is valid even if earlier bytes were skipped
  }
  if (head.op == McapOp::footer) state_ = State::after_footer;
  consume(whole.size() - surplus);
  if (surplus > 0) judge_surplus(head.op, surplus);
  return record;
}

/// Returns true if the record is a chunk with another opcode.
bool McapReader::is_hidden_chunk(std::string_view whole) {
  const auto chunk = plausible_chunk(whole, longest_);
  return chunk && mcap_record_head + chunk->size() == whole.size() && is_chunk(*chunk);
}

/// Handles the bytes after the known fields of a record. If the record's length is damaged, they
/// are the next records of the file.
void McapReader::judge_surplus(McapOp op, std::size_t surplus) {
  const bool is_known = op <= McapOp::data_end;
  if (is_known && surplus > most_surplus) {
    report(Severity::error, "a record as long as its fields", "a longer record",
           "what follows its fields is read as the next record");
    crc_counts_ = false;
    return;
  }
  constexpr auto first_private = static_cast<McapOp>(0x80);  // lower opcodes are MCAP's own
  if (!is_known && op < first_private) {
    report(Severity::warning, "a record with a known opcode", "another opcode",
           "the record is skipped");
  }
  surplus_end_ = offset_ + surplus;
  state_ = State::surplus;
}

/// Compares the checksum in a data end or footer record with crc_. `bytes`: the whole record. crc_
/// covers the bytes before the record.
void McapReader::check_crc(const McapRecord& record, std::string_view bytes) {
  // After skipped bytes the checksum can't match. The data of the summary are then not used either.
  if (!crc_counts_) {
    if (std::holds_alternative<McapFooter>(record)) is_summary_damaged_ = true;
    return;
  }
  std::uint32_t stated = 0, covered = crc_;
  if (const auto* end = std::get_if<McapDataEnd>(&record)) {
    stated = end->data_crc;
    all_checked_ = stated != 0 && stated == covered;
  } else if (const auto* footer = std::get_if<McapFooter>(&record)) {
    constexpr std::size_t fields = mcap_record_head + 8 + 8;
    stated = footer->summary_crc;
    // The checksum covers the footer's fields before the checksum.
    covered = crc_of(bytes.substr(0, fields), crc_);
    is_summary_damaged_ = stated != 0 && stated != covered;
  }
  if (stated != 0 && stated != covered) {
    report(Severity::error, "the checksum of the data before it", "another checksum",
           "some of this data is damaged");
  }
}

/// Returns true if a chunk with consistent sizes is at this position. Its records may still be
/// damaged.
bool McapReader::open_chunk(std::string_view content) {
  const auto chunk = decode_mcap_chunk(content);
  if (!chunk || content.size() != chunk->size()) return false;
  // A checksum of 0 means that the writer computed none.
  uncovered_ = chunk->head.uncompressed_crc == 0;
  auto records = unpack(*chunk, longest_);
  if (records) {
    chunk_ = *std::move(records);
  } else {
    // Only this chunk is lost. Its sizes are consistent, so the position of the next record is
    // known.
    report(Severity::error, records.error().expected, records.error().found,
           "the chunk's messages are left out");
    skipped_ += content.size();
  }
  return true;
}

/// Handles the end of the file within a record. If a valid chunk follows later, the record's head
/// is damaged. Otherwise the file is truncated.
void McapReader::end_in_record() {
  // The search changes the position. The old position is restored afterwards, because findings need
  // the position of this record.
  const std::size_t taken = taken_;
  const std::uint64_t offset = offset_, skipped_before = skipped_;
  state_ = State::lost;
  // The search has all bytes of the file, because end() was called.
  find_chunk();
  const bool damaged = state_ == State::records;
  const std::size_t skipped = taken_ - taken;
  taken_ = taken;
  offset_ = offset;
  skipped_ = skipped_before;
  if (damaged) {
    report(Severity::error, "a record", "a record longer than the file",
           "what stands there is left out, up to the next whole chunk");
    crc_counts_ = false;
    skip(skipped);
    return;
  }
  const std::string_view bytes = rest();
  // Messages can be recovered only from a truncated chunk. Other truncated records are left out.
  const auto chunk = decode_mcap_head(bytes) && decode_mcap_head(bytes)->op == McapOp::chunk
                         ? decode_mcap_chunk(bytes.substr(mcap_record_head))
                         : std::nullopt;
  report(Severity::warning, "a complete record", "the end of the file within a record",
         chunk ? "the chunk's messages before the end are read without a checksum"
               : "the record is skipped");
  record_at_ = offset_;
  record_size_ = bytes.size();
  in_truncated_chunk_ = true;
  if (chunk) chunk_ = unpack_truncated(*chunk, longest_);
  consume(bytes.size());
}

/// Returns true if the bytes are a chunk. Plausible fields make this likely, and unpacking with the
/// checksum proves it. A file may contain many false chunks, so tried_ sums up the work of failed
/// attempts.
bool McapReader::is_chunk(const McapChunkView& chunk) {
  constexpr std::uint64_t beginning = std::uint64_t{128} << 10;  // memory for zstd, counted as work
  const bool is = unpack(chunk, longest_).has_value();
  if (is) return true;
  tried_ += chunk.stored_size + chunk.head.uncompressed_size;
  if (!chunk.head.compression.empty()) tried_ += beginning;
  return false;
}

// Searches for the next chunk, in the state surplus only up to surplus_end_. A damaged file may
// contain many false candidates, so the work is limited to most_tried bytes.
void McapReader::find_chunk() {
  constexpr std::uint64_t most_tried = std::uint64_t{1} << 30;
  const bool is_lost = state_ == State::lost;
  while (!rest().empty() && (is_lost || offset_ < surplus_end_)) {
    const std::string_view bytes = rest();
    // The head of a candidate may not have arrived completely.
    if (bytes.size() < longest_chunk_head && !ended_) return;
    const auto chunk = tried_ < most_tried ? plausible_chunk(bytes, longest_) : std::nullopt;
    // The candidate looks like a chunk but is incomplete. The decision needs more bytes.
    if (chunk && !chunk->whole() && !ended_) return;
    if (chunk && chunk->whole() && is_chunk(*chunk)) {
      if (!is_lost) report_damage("a record that contains no chunk", "a chunk");
      found_size_ = chunk->size();
      state_ = State::records;
      return;
    }
    is_lost ? skip(1) : consume(1);
  }
  if (!is_lost) state_ = State::records;
}

void McapReader::find_magic() {
  const std::string_view bytes = rest();
  // Exactly the magic must follow. One more byte would show that the file continues.
  if (bytes.size() <= mcap_magic.size() && !ended_) return;
  if (bytes == mcap_magic) {
    state_ = State::closed;
    consume(bytes.size());
    return;
  }
  const bool is_end = bytes.starts_with(mcap_magic);
  report(Severity::error, "the MCAP magic after the footer", "other bytes",
         is_end ? "the bytes after the magic are ignored"
                : "what stands there is left out, up to the next whole chunk");
  state_ = is_end ? State::bad_end : State::lost;
}

}  // namespace kinalign
