// SPDX-License-Identifier: Apache-2.0
// The records of a recording's files, read side by side: a file may fill a hole of an earlier one.
// Within a file log times do not rise: device after device is read. Each file stays open and holds
// a piece and a chunk; each message looks at all files' next ones: for some tens of files at most.
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
  const McapRecord* record = nullptr;  // good until the next one is taken
  std::size_t part = 0;
};

class MergedParts {
 public:
  /// `parts` has to stay.
  static Result<MergedParts> open(FileSystem& files, const RecordingParts& parts,
                                  const Progress& progress);

  /// A message once no other file has to give a lower one of its channel (where files wait for one
  /// another so that none could go on: before it), of several such the earliest; what else there is
  /// as soon as it stands first in its file. Absent: all were taken.
  /// Fails where a file is no MCAP file or can't be read, but for pages of a bad disk: see
  /// unread().
  Result<std::optional<PartRecord>> next();

  const McapReader& reader(std::size_t part) const { return parts_[part]->reader; }
  /// What it did not believe of the file's torn end was left out.
  const NumberGuard& guard(std::size_t part) const { return parts_[part]->guard; }
  /// Bytes that the disk did not give: they came as zeros.
  std::uint64_t unread(std::size_t part) const { return parts_[part]->file.unread(); }

 private:
  struct Part {
    InputFile file;
    const RecordingPart* told = nullptr;
    McapReader reader{};
    NumberGuard guard{};
    std::optional<McapRecord> head{};
    std::map<std::uint16_t, std::uint64_t> given{};  // by channel: behind the last one
  };
  Result<void> advance(Part& part);
  Result<std::optional<McapRecord>> pull_from(Part& part);
  static bool is_stray(Part& part);
  std::optional<std::size_t> first() const;
  bool waits(std::size_t part, const McapMessage& message) const;

  std::vector<std::unique_ptr<Part>> parts_;
  std::optional<std::size_t> taken_;  // whose head was given
  Progress progress_;
  std::uint64_t done_ = 0, total_ = 0;  // bytes
};

}  // namespace kinalign
