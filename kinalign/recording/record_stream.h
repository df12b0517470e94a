// SPDX-License-Identifier: Apache-2.0
// Reads all parts of a recording as one stream of records. Each message is returned once, by the
// number in its channel. A part therefore fills gaps of another part. The messages of a channel are
// returned in the order of their numbers. Messages of a truncated chunk have no checksum and come
// last. docs/formats/recording.md.
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

/// Merges the parts record by record. Each part keeps its next record in `head`, and first()
/// chooses among them. Apart from ranges of numbers, the memory does not grow with the files.
class RecordStream {
 public:
  /// Receives each piece of a file and the index of the part, in the order of the file.
  using TakePiece = std::function<void(std::size_t part, std::string_view piece)>;

  /// Opens the parts. Several parts are first read completely, to learn which messages each part
  /// has.
  static Result<RecordStream> open(FileSystem& files, const RecordingParts& parts,
                                   const Progress& progress, TakePiece take_piece = {});

  /// Returns the next record; nullptr after the last one. It is valid until the next call. A
  /// definition without a checksum is left out if another part has it with a checksum. Metadata and
  /// attachments come from the first part that has a record of their name. Fails if a part is not
  /// an MCAP file or cannot be read.
  Result<const McapRecord*> next();

  // The part of the last record.
  std::size_t part() const { return *taken_; }
  const McapReader& reader() const { return parts_[*taken_].reader; }
  /// The index of the last message in its chunk.
  std::uint32_t place() const { return parts_[*taken_].place; }

  // The results below are valid after the last record.
  const MessageNumbers& numbers() const { return numbers_; }  // numbers of the returned messages
  /// The count of missing messages. It comes from their numbers or, for a single file, from the
  /// statistics in the file.
  std::uint64_t missing() const;
  std::uint64_t unchecked() const;                      // messages without a checksum
  std::uint64_t repeated() const { return repeated_; }  // copies that were left out
  std::uint64_t skipped() const;                        // unreadable bytes of all files
  std::uint64_t bytes() const { return done_; }         // bytes of all files
  Ending ending() const;
  std::vector<std::string> truncated() const;  // paths of the parts without index or end
  /// Findings about damaged parts, and about messages that are out of order or were left out.
  Findings findings() const;

 private:
  /// One file that is being read.
  struct Part {
    InputFile file;
    bool is_ours = false;
    MessageNumbers numbers{};                      // with a checksum; empty for a single part
    std::map<std::uint16_t, std::uint64_t> end{};  // by channel: one more than the last number read
    McapReader reader{};
    std::optional<McapRecord> head{};         // the next record
    std::uint64_t chunk = 0;                  // position of the chunk that contains `head`
    std::uint32_t place = 0;                  // index of `head` among the messages of the chunk
    std::uint64_t passed = 0, unchecked = 0;  // returned messages; those of them without a checksum
    std::uint64_t impossible = 0;             // messages left out because of their number
    bool has_chunks = false;                  // a message of a chunk with a checksum was read
    std::uint64_t outside = 0;                // messages left out because no chunk contains them
    std::uint64_t counted = 0;                // messages by the statistics in the file
  };
  Result<void> learn(FileSystem& files, const RecordingParts& parts);
  Result<void> advance(Part& part);
  std::optional<std::size_t> first() const;
  bool waits(const Part& part, const McapMessage& message) const;
  bool passes(Part& part);
  bool passes(Part& part, const McapMessage& message);
  static bool is_outside(Part& part);
  bool is_first(const std::string& name);
  bool is_last_part() const { return *taken_ + 1 == parts_.size(); }

  std::vector<Part> parts_;
  std::optional<std::size_t> taken_;  // the part of the last record; empty before the first
  McapDefinitions checked_;           // definitions with a checksum; empty for a single part
  MessageNumbers numbers_;
  std::map<std::string, std::size_t> names_;  // names of metadata and attachments; their parts
  Ending ending_ = Ending::none;              // according to the metadata
  bool in_order_ = true;
  std::uint64_t repeated_ = 0;
  Progress progress_;
  TakePiece take_piece_;
  std::uint64_t done_ = 0, total_ = 0;  // bytes
};

}  // namespace kinalign
