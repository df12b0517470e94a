// SPDX-License-Identifier: Apache-2.0
// The records of a recording's files, read side by side: a file may fill a hole of an earlier one.
// Within a file log times do not rise: device after device is read.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/io/mcap_reader.h"
#include "kinalign/io/recording_parts.h"

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

  /// A message once no other file has to give a lower one of its channel, of several such the
  /// earliest; what else there is as soon as it stands first in its file. Absent: all were taken.
  /// Fails where a file can't be read or is no MCAP file.
  Result<std::optional<PartRecord>> next();

  const McapReader& reader(std::size_t part) const { return parts_[part]->reader; }

 private:
  struct Part {
    InputFile file;
    const MessageNumbers* numbers = nullptr;
    McapReader reader{};
    std::optional<McapRecord> head{};
    bool ended = false;
    std::map<std::uint16_t, std::uint64_t> given{};  // by channel: behind the last one
  };
  Result<void> advance(Part& part);
  std::optional<std::size_t> first() const;
  bool waits(std::size_t part, const McapMessage& message) const;

  std::vector<std::unique_ptr<Part>> parts_;
  std::optional<std::size_t> taken_;  // whose head was given
  Progress progress_;
  std::uint64_t done_ = 0, total_ = 0;  // bytes
};

}  // namespace kinalign
