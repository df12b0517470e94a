// SPDX-License-Identifier: Apache-2.0
// The content of one file of a recording: docs/formats/recording.md.
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
  RecordingFacts facts;  // empty for a file of another program, which stands alone
  MessageNumbers numbers{};
  MessageNumbers nameless{};      // messages of channels that this file does not define
  MessageNumbers unproved{};      // messages without a checksum
  McapDefinitions definitions{};  // covered by a checksum
  // Not covered by a checksum.
  McapDefinitions unproved_definitions{};
  std::set<std::string> names{};      // of metadata and attachments, see name_of()
  bool is_sound = true;               // the file has no damage and no message without a channel
  bool all_checked = false;           // a checksum covers the whole file
  Ending ending = Ending::none;       // `torn` for a truncated file
  std::set<std::uint16_t> repeats{};  // channels taken from earlier files, see stands_elsewhere()
};

/// The name by which a record of a later file is recognised as a repetition.
std::string name_of(const McapMetadata& metadata);
std::string name_of(const McapAttachment& attachment);

/// The end of several files together. It is the end of the file with the highest part number,
/// unless a file has a proper end, since nothing follows that.
struct EndTogether {
  Ending ending = Ending::none;
  int until = 0;  // highest part number so far

  EndTogether with(Ending next, const RecordingFacts& facts) const {
    if (next == Ending::ended) return {next, facts.last_part()};
    if (ending == Ending::ended || facts.last_part() < until) return *this;
    return {next, facts.last_part()};
  }
};

/// Reads a file once. On a bad disk it is read as far as possible.
Result<RecordingPart> read_part(FileSystem& files, const std::string& path,
                                const RecordingFacts& facts, const Progress& progress);

}  // namespace kinalign
