// SPDX-License-Identifier: Apache-2.0
// Reads all parts of a recording as one stream of records. Each message is returned once, and the
// messages of each channel by their numbers, so a part fills a gap of another part. A message
// passes if its number is new in its channel. The messages of a truncated chunk, which has no
// checksum, come last. docs/formats/recording.md.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/mcap/reader.h"
#include "kinalign/recording/message_numbers.h"
#include "kinalign/recording/parts.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// Merges the parts record by record. Each part keeps one record in hand (`head`), and the next one
/// of all parts is chosen by first(). Memory does not grow with the files, apart from ranges of
/// numbers.
class RecordStream {
 public:
  /// Receives each piece of a file, in the file's order, with the index of the part.
  using TakePiece = std::function<void(std::size_t part, std::string_view piece)>;

  /// Opens the parts. Several parts are read once before, to learn which messages each has.
  static Result<RecordStream> open(FileSystem& files, const RecordingParts& parts,
                                   const Progress& progress, TakePiece take_piece = {});

  /// Returns the next record, valid until the next call; nullptr after the last one. A definition
  /// without a checksum is left out if another part has it with one. Metadata and attachments are
  /// taken from the first part that has their name. Fails if a part is no MCAP file or cannot be
  /// read.
  Result<const McapRecord*> next();

  // The place of the last record.
  std::size_t part() const { return *taken_; }
  const McapReader& reader() const { return parts_[*taken_].reader; }
  /// The index of the message in its chunk.
  std::uint32_t place() const { return parts_[*taken_].place; }

  // Valid after the last record.
  const MessageNumbers& numbers() const { return numbers_; }  // of the messages that passed
  /// Messages known to be missing, by their numbers or, for a single file, by its own count.
  std::uint64_t missing() const;
  std::uint64_t unchecked() const;                      // messages without a checksum
  std::uint64_t repeated() const { return repeated_; }  // copies that were left out
  std::uint64_t skipped() const;                        // unreadable bytes of all files
  std::uint64_t bytes() const { return done_; }         // bytes of all files
  Ending ending() const;
  std::vector<std::string> truncated() const;  // paths of the parts without index or end
  /// Damage of the parts, and messages that are out of order or were left out.
  Findings findings() const;

 private:
  /// One file in the middle of being read.
  struct Part {
    InputFile file;
    bool is_ours = false;
    MessageNumbers numbers{};                      // messages with a checksum; empty for one part
    std::map<std::uint16_t, std::uint64_t> end{};  // by channel: one more than the last number read
    McapReader reader{};
    std::optional<McapRecord> head{};         // the next record
    std::uint64_t chunk = 0;                  // position of the chunk of `head`
    std::uint32_t place = 0;                  // index of `head` among the chunk's messages
    std::uint64_t passed = 0, unchecked = 0;  // messages; those without a checksum
    std::uint64_t impossible = 0;             // messages that were left out
    std::uint64_t counted = 0;                // messages by the file's own statistics
  };
  Result<void> learn(FileSystem& files, const RecordingParts& parts);
  Result<void> advance(Part& part);
  std::optional<std::size_t> first() const;
  bool waits(const Part& part, const McapMessage& message) const;
  bool passes(Part& part);
  bool passes(Part& part, const McapMessage& message);
  bool is_first(const std::string& name);
  bool is_last_part() const { return *taken_ + 1 == parts_.size(); }

  std::vector<Part> parts_;
  std::optional<std::size_t> taken_;  // the part of the last record
  McapDefinitions checked_;           // definitions that a checksum covers; empty for one part
  MessageNumbers numbers_;
  std::map<std::string, std::size_t> names_;  // metadata and attachments, and their parts
  Ending ending_ = Ending::none;              // by the metadata
  bool in_order_ = true;
  std::uint64_t repeated_ = 0;
  Progress progress_;
  TakePiece take_piece_;
  std::uint64_t done_ = 0, total_ = 0;  // bytes
};

}  // namespace kinalign
