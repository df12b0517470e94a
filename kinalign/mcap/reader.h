// SPDX-License-Identifier: Apache-2.0
// Reads an MCAP file from beginning to end. The caller passes pieces of the file, and the reader
// returns records. Instead of a chunk, it returns the records in the chunk. Damaged parts are
// skipped and reported, and reading continues at the next recognisable chunk. No checksum covers
// the opcode and the length of a record, so a chunk is recognised by its own sizes and checksum.
// The file may be truncated. The reader keeps the current record and chunk in memory, at most
// `most_record` bytes each.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/mcap/chunk.h"
#include "kinalign/mcap/records.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kinalign {

/// The file may be cut into pieces anywhere.
class McapReader {
 public:
  static constexpr std::uint64_t most_record = std::uint64_t{256} << 20;

  /// Records and chunks longer than `longest_record` count as damage. This limits the memory.
  explicit McapReader(std::uint64_t longest_record = most_record) : longest_(longest_record) {}

  /// Adds the next bytes of the file.
  void feed(std::string_view piece);
  /// Call this when the file has no more bytes.
  void end() { ended_ = true; }
  bool ended() const { return ended_; }

  /// Returns the next record. An empty result means that more bytes are needed or, after end(),
  /// that no record is left. The data of a message are valid until the next call of any function.
  std::optional<McapRecord> next();

  /// The position of the last record, or of the chunk that contains it, in the file.
  std::uint64_t at() const { return record_at_; }
  /// The size of that record or chunk, bytes. If it is truncated, only the present bytes count.
  std::uint64_t size() const { return record_size_; }
  /// True if the file has the end of a properly closed file. Otherwise the file is truncated.
  bool closed() const { return state_ == State::closed; }
  bool is_mcap() const { return state_ != State::foreign; }
  /// True if no chunk's checksum covers the last record. The record is in a truncated chunk, in a
  /// chunk without a checksum, or outside of chunks.
  bool unchecked() const { return in_truncated_chunk_ || uncovered_; }
  /// True if the last record is not in a chunk.
  bool outside_chunks() const { return chunk_.empty(); }
  /// True if the last record is in a chunk that the end of the file cuts off.
  bool in_truncated_chunk() const { return in_truncated_chunk_; }
  /// True if the checksum of the data section covers every message. The result is valid after the
  /// end of the section.
  bool all_checked() const { return all_checked_; }
  /// True if the checksum of the summary is wrong. The result is valid at the end of the file.
  bool is_summary_damaged() const { return is_summary_damaged_; }
  /// The number of skipped bytes: bytes that are no record, or have a wrong checksum. Bytes that
  /// are missing from a truncated file are not counted.
  std::uint64_t skipped() const { return skipped_; }
  /// At most 200 findings. The text `found` of each one contains the position.
  const Findings& findings() const { return findings_; }

 private:
  // start: before the magic. records: at a record. surplus: in the bytes after the known fields of
  // a record. lost: searching for the next chunk. after_footer: before the magic at the end.
  // closed, bad_end and foreign: finished.
  enum class State : std::uint8_t {
    start,
    records,
    surplus,
    lost,
    after_footer,
    closed,
    bad_end,
    foreign
  };
  // The result of look(): too few bytes, a complete record, the truncated end of the file, or
  // skipped damage.
  enum class Look : std::uint8_t { nothing, whole, truncated, damaged };
  Look look();
  std::optional<McapRecord> read_record();
  std::optional<McapRecord> next_in_chunk();
  std::optional<McapRecord> next_in_file();
  bool take(McapOp op, std::string_view content, std::optional<McapRecord>& record,
            std::size_t& surplus);
  bool is_hidden_chunk(std::string_view whole);
  void judge_surplus(McapOp op, std::size_t surplus);
  void start();
  bool open_chunk(std::string_view content);
  void end_in_record();
  void find_chunk();
  bool is_chunk(const McapChunkView& chunk);
  void find_magic();
  void check_crc(const McapRecord& record, std::string_view bytes);
  void consume(std::size_t size);
  void skip(std::size_t size);
  void report_damage(std::string expected, std::string found);
  void report(Severity severity, std::string expected, std::string found, std::string meaning);
  std::string_view rest() const { return std::string_view(buffer_).substr(taken_); }

  std::uint64_t longest_;
  State state_ = State::start;
  bool ended_ = false;
  // buffer_ contains bytes of the file, and the first taken_ bytes are read. The next feed()
  // removes these, so views into buffer_ are valid until then.
  std::string buffer_;
  std::size_t taken_ = 0;     // bytes of buffer_ that were read
  std::uint64_t offset_ = 0;  // position of the next byte in the file
  std::uint64_t record_at_ = 0, record_size_ = 0;
  std::uint64_t found_size_ = 0;   // content of the chunk that was found here, bytes; 0: none
  std::uint64_t surplus_end_ = 0;  // in the state surplus: the position of the next record
  std::uint32_t crc_ = 0;          // checksum of the data section, later of the summary
  bool crc_counts_ = true;         // false after a skipped byte
  std::string chunk_;              // records of the current chunk
  std::size_t chunk_taken_ = 0;
  bool in_truncated_chunk_ = false, uncovered_ = false;
  // all_checked_ and is_summary_damaged_ stay false until the record with the checksum is read.
  bool all_checked_ = false, is_summary_damaged_ = false;
  std::uint64_t skipped_ = 0;
  std::uint64_t tried_ = 0;  // bytes that were unpacked for false chunks
  Findings findings_;
};

/// Returns the reader's next record and requests pieces as needed. An empty piece means the end of
/// the file. The result is empty after the last record, or if the file is not an MCAP file. Fails
/// if `next_piece` fails.
template <class NextPiece>
Result<std::optional<McapRecord>> pull(McapReader& reader, const NextPiece& next_piece) {
  for (;;) {
    if (auto record = reader.next()) return record;
    if (reader.ended() || !reader.is_mcap()) return std::optional<McapRecord>();
    const std::string_view piece = KA_TRY(next_piece());
    if (piece.empty()) {
      reader.end();
    } else {
      reader.feed(piece);
    }
  }
}

}  // namespace kinalign
