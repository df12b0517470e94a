// SPDX-License-Identifier: Apache-2.0
// Reads the records of a recording's files together, because a file may fill a gap of an earlier
// one. Log times in a file need not increase, because the recorder reads one device after another.
// Each open file holds a piece and a chunk in memory, and each message is compared with the next
// message of all files. This is fast enough for some tens of files.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/mcap/reader.h"
#include "kinalign/recording/parts.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace kinalign {

struct PartRecord {
  const McapRecord* record = nullptr;  // valid until the next record is taken
  std::size_t part = 0;
};

class MergedParts {
 public:
  /// `parts` must outlive the object.
  static Result<MergedParts> open(FileSystem& files, const RecordingParts& parts,
                                  const Progress& progress);

  /// Returns the next record. A message is returned only when no other file still has a lower
  /// number of its channel. Of several such messages the earliest comes first. If all files wait
  /// for one another, the earliest message is returned nevertheless. Other records are returned as
  /// soon as they are next in their file. Absent: all records were returned.
  /// Fails if a file is not an MCAP file or cannot be read. Pages that a bad disk cannot read are
  /// no failure: see unread().
  Result<std::optional<PartRecord>> next();

  const McapReader& reader(std::size_t part) const { return parts_[part]->reader; }
  /// The guard of a part. Messages at the truncated end that it did not believe were left out.
  const NumberGuard& guard(std::size_t part) const { return parts_[part]->guard; }
  /// Bytes that the disk could not read; they were replaced by zeros.
  std::uint64_t unread(std::size_t part) const { return parts_[part]->file.unread(); }

 private:
  struct Part {
    InputFile file;
    const RecordingPart* told = nullptr;
    McapReader reader{};
    NumberGuard guard{};
    std::optional<McapRecord> head{};
    std::map<std::uint16_t, std::uint64_t> given{};  // by channel: one more than the last number
  };
  Result<void> advance(Part& part);
  Result<std::optional<McapRecord>> pull_from(Part& part);
  static bool is_stray(Part& part);
  std::optional<std::size_t> first() const;
  bool waits(std::size_t part, const McapMessage& message) const;

  std::vector<std::unique_ptr<Part>> parts_;
  std::optional<std::size_t> taken_;  // the part whose record was returned last
  Progress progress_;
  std::uint64_t done_ = 0, total_ = 0;  // bytes
};

}  // namespace kinalign
