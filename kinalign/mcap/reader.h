// SPDX-License-Identifier: Apache-2.0
// Reads an MCAP file from beginning to end. The file may be truncated. The caller feeds pieces, and
// the reader returns records, with those of a chunk in place of the chunk. Damaged parts are
// skipped and reported, and reading continues at the next recognisable chunk. Memory: the present
// record and chunk, at most `most_record` bytes each.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/mcap/chunk.h"
#include "kinalign/mcap/records.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kinalign {

/// The caller may cut the file into pieces at any place.
class McapReader {
 public:
  static constexpr std::uint64_t most_record = std::uint64_t{256} << 20;

  /// A record or chunk longer than `longest_record` is treated as damage. This limits the memory.
  explicit McapReader(std::uint64_t longest_record = most_record) : longest_(longest_record) {}

  /// Adds the next bytes of the file.
  void feed(std::string_view piece);
  /// Call when the file has no more bytes.
  void end() { ended_ = true; }
  bool ended() const { return ended_; }

  /// Returns the next record. Absent: more bytes are needed or, after end(), there is no more
  /// record. The data of a message is valid until the next call of any function.
  std::optional<McapRecord> next();

  /// Position in the file of the last record, or of its chunk.
  std::uint64_t at() const { return record_at_; }
  /// Bytes of that record or chunk. For a truncated one, the bytes that are present.
  std::uint64_t size() const { return record_size_; }
  /// Returns whether the file ends as a properly closed file. Otherwise it is truncated, even if
  /// much of it was read.
  bool closed() const { return state_ == State::closed; }
  bool is_mcap() const { return state_ != State::foreign; }
  /// Returns whether no chunk's checksum covers the last record: it is in a truncated chunk, in a
  /// chunk without a checksum, or outside of chunks.
  bool unchecked() const { return in_truncated_chunk_ || uncovered_; }
  /// Returns whether the last record is in the chunk in which the file ends.
  bool in_truncated_chunk() const { return in_truncated_chunk_; }
  /// Returns whether the checksum of the data section covers every message. Known at the end of the
  /// section.
  bool all_checked() const { return all_checked_; }
  /// Returns whether the summary's checksum is wrong. Known at the end of the file.
  bool is_summary_damaged() const { return is_summary_damaged_; }
  /// Bytes of the file that were skipped: not a record, or with a wrong checksum. Bytes that a
  /// truncated file lacks are not counted.
  std::uint64_t skipped() const { return skipped_; }
  /// Findings, each with its position in `found`; 200 at most.
  const Findings& findings() const { return findings_; }

 private:
  // start: before the magic. records: at a record. lost: searching for the next chunk.
  // after_footer: before the last magic. closed, bad_end, foreign: final states.
  enum class State : std::uint8_t { start, records, lost, after_footer, closed, bad_end, foreign };
  // The result of look(): too few bytes, a complete record, the file's truncated end, or damage
  // that was skipped.
  enum class Look : std::uint8_t { nothing, whole, truncated, damaged };
  Look look();
  std::optional<McapRecord> read_record();
  std::optional<McapRecord> next_in_chunk();
  std::optional<McapRecord> next_in_file();
  bool take(McapOp op, std::string_view content, std::optional<McapRecord>& record);
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
  // buffer_ holds the bytes that were fed and are not yet dropped; the first taken_ of them are
  // read. feed() drops them, so views into buffer_ are valid until then.
  std::string buffer_;
  std::size_t taken_ = 0;     // bytes of buffer_ that were read
  std::uint64_t offset_ = 0;  // position in the file of the next byte
  std::uint64_t record_at_ = 0, record_size_ = 0;
  std::uint32_t crc_ = 0;   // checksum of the data section, later of the summary
  bool crc_counts_ = true;  // no byte covered by crc_ was skipped
  std::string chunk_;       // records of the present chunk
  std::size_t chunk_taken_ = 0;
  bool in_truncated_chunk_ = false, uncovered_ = false;
  // all_checked_ and is_summary_damaged_ stay false until the record with the checksum is read.
  bool all_checked_ = false, is_summary_damaged_ = false;
  std::uint64_t skipped_ = 0;
  std::uint64_t tried_ = 0;  // bytes tried as a chunk without success
  Findings findings_;
};

/// Returns the reader's next record and feeds pieces as needed. An empty piece is the end of the
/// file. Absent after the last record, or if the file is not an MCAP file. Fails if `next_piece`
/// fails.
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
