// SPDX-License-Identifier: Apache-2.0
// What one of a recording's files brings: docs/formats/recording.md.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/mcap/chunk.h"
#include "kinalign/recording/format.h"
#include "kinalign/recording/message_numbers.h"

#include <cstdint>
#include <set>
#include <string>

namespace kinalign {

struct RecordingPart {
  bool is_ours() const { return !facts.first.empty(); }

  std::string path;
  RecordingFacts facts;  // of a file that is none of ours, which stands alone: none
  MessageNumbers numbers{};
  MessageNumbers nameless{};      // of channels that this file does not define
  MessageNumbers unproved{};      // those that no checksum covers
  McapDefinitions definitions{};  // that a checksum covers
  McapDefinitions unproved_definitions{};
  std::set<std::string> names{};  // of metadata and attachments, as name_of() has them
  bool is_sound = true;           // nothing in it was damaged or without a name
  bool all_checked = false;       // a checksum covers all of it
  Ending ending = Ending::none;   // of a file that breaks off: torn
  std::set<std::uint16_t>
      repeats{};  // channels: what files before have counts, see stands_elsewhere()
};

/// What a record of the same name in a later file repeats.
std::string name_of(const McapMetadata& metadata);
std::string name_of(const McapAttachment& attachment);

/// How files end together: as the one whose messages reach furthest, but for an end, which nothing
/// comes behind.
struct EndTogether {
  Ending ending = Ending::none;
  int until = 0;  // the furthest one's last part

  EndTogether with(Ending next, const RecordingFacts& facts) const {
    if (next == Ending::ended) return {next, facts.last_part()};
    if (ending == Ending::ended || facts.last_part() < until) return *this;
    return {next, facts.last_part()};
  }
};

/// Reads the file once, a bad disk's as far as it can be read.
Result<RecordingPart> read_part(FileSystem& files, const std::string& path,
                                const RecordingFacts& facts, const Progress& progress);

}  // namespace kinalign
