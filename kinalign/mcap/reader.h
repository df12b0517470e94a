// SPDX-License-Identifier: Apache-2.0
// An MCAP file from front to end, whole or torn: fed pieces, it yields records, those of chunks in
// their place. What is damaged is left out and said; reading goes on behind it where a chunk can be
// recognised again. Memory: the record or chunk that is read, at most `most_record` each.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/mcap/chunk.h"
#include "kinalign/mcap/records.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kinalign {

class McapReader {
 public:
  static constexpr std::uint64_t most_record = std::uint64_t{256} << 20;

  /// A longer record or chunk is damage. Memory goes by it.
  explicit McapReader(std::uint64_t longest_record = most_record) : longest_(longest_record) {}

  /// The next bytes of the file.
  void feed(std::string_view piece);
  /// There are no more.
  void end() { ended_ = true; }
  bool ended() const { return ended_; }

  /// The next record; absent: more bytes are needed, or, after end(), there is none. A message's
  /// data is good until the next call of anything.
  std::optional<McapRecord> next();

  /// Of the record that next() gave, or of its chunk.
  std::uint64_t at() const { return record_at_; }
  /// Bytes of that record or chunk; of one at which the file breaks off as many as there are.
  std::uint64_t size() const { return record_size_; }
  /// Ends as a file does that was closed. Else it is torn, however much of it was read.
  bool closed() const { return state_ == State::closed; }
  bool is_mcap() const { return state_ != State::foreign; }
  /// No checksum of a chunk covers the last record: it stands in the chunk at which the file breaks
  /// off, in one without a checksum, or in none.
  bool unchecked() const { return in_torn_chunk_ || uncovered_; }
  /// The last record stands in the chunk at which the file breaks off.
  bool in_torn_chunk() const { return in_torn_chunk_; }
  /// The data section's checksum, read at its end, covers every message of the file.
  bool all_checked() const { return all_checked_; }
  /// The summary's checksum, read at the file's end, does not fit.
  bool summary_spoilt() const { return summary_spoilt_; }
  /// Bytes of the file that were left out: no record, or one whose checksum does not fit. What a
  /// torn file lacks is not among them.
  std::uint64_t skipped() const { return skipped_; }
  /// What was wrong, each with its place in `found`; no more than some hundred.
  const Findings& findings() const { return findings_; }

 private:
  enum class State : std::uint8_t { start, records, lost, behind_footer, closed, spoilt, foreign };
  enum class Stand : std::uint8_t { nothing, whole, torn, damaged };
  Stand look();
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
  void lose(std::string expected, std::string found);
  void say(Severity severity, std::string expected, std::string found, std::string meaning);
  std::string_view rest() const { return std::string_view(buffer_).substr(taken_); }

  std::uint64_t longest_;
  State state_ = State::start;
  bool ended_ = false;
  std::string buffer_;
  std::size_t taken_ = 0;     // bytes of it that were read
  std::uint64_t offset_ = 0;  // of what comes then, in the file
  std::uint64_t record_at_ = 0, record_size_ = 0;
  std::uint32_t crc_ = 0;   // of the data section, then of the summary
  bool crc_counts_ = true;  // nothing of that was skipped
  std::string chunk_;       // its records
  std::size_t chunk_taken_ = 0;
  bool in_torn_chunk_ = false, uncovered_ = false;
  bool all_checked_ = false, summary_spoilt_ = false;
  std::uint64_t skipped_ = 0;
  std::uint64_t tried_ = 0;  // bytes that were gone through in vain, looking for a chunk
  Findings findings_;
};

/// The reader's next record, fed with pieces as it needs them: an empty one is the file's end.
/// Absent behind the last one, and once it is no MCAP file. Fails as `next_piece` does.
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
