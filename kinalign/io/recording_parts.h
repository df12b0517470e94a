// SPDX-License-Identifier: Apache-2.0
// The files of one recording: it goes on in NAME.part2.mcap where its disk had failed, and that one
// begins with all that the disk had not confirmed. docs/formats/recording.md.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/io/message_numbers.h"
#include "kinalign/io/recording_format.h"
#include "kinalign/io/recording_survey.h"

#include <set>
#include <string>
#include <vector>

namespace kinalign {

struct RecordingPart {
  std::string path;
  RecordingFacts facts;
  MessageNumbers numbers{};
  MessageNumbers unproved{};          // those that no checksum covers
  std::set<std::string> names{};      // of metadata and attachments, as name_of() has them
  bool is_sound = true;               // nothing in it was damaged or without a name
  Ending ending = Ending::none;       // of a file that breaks off: torn
  std::set<std::uint16_t> repeats{};  // channels of which what files before have counts, see below
};

/// In their order.
using RecordingParts = std::vector<RecordingPart>;

/// What a record of the same name in a later file repeats.
std::string name_of(const McapMetadata& metadata);
std::string name_of(const McapAttachment& attachment);

/// Whether a better copy of this part's message stands in another: one that a checksum covers, or
/// as good a one of a later file. Of the earlier one the disk had not said that it is there.
bool has_better(const RecordingParts& parts, std::size_t part, const McapMessage& message);

/// For who reads one file behind the other. What stands twice is taken from the later file, of the
/// earlier one the disk had not said that it is there; but not where the later one ends before the
/// earlier or is less sure.
bool stands_elsewhere(const RecordingParts& parts, std::size_t part, const McapMessage& message);

/// Reads these files once. Those that repeat others and say nothing more are left out:
/// of one that `recover` has made all parts are. Fails where they are not all of one recording.
Result<RecordingParts> read_parts(FileSystem& files, const std::vector<std::string>& paths,
                                  const Progress& progress);

/// The file and, as they lie in the same folder, those that its recording went on in.
Result<RecordingParts> parts_from(FileSystem& files, const std::string& path,
                                  const Progress& progress);

/// That the first of these is not all of its recording; the others were read with it or not.
enum class PartsBehind { left, read };
Findings judge_parts(const RecordingParts& parts, PartsBehind behind);

/// A survey of the first of these with what those behind add to it: channels, their messages, each
/// once (bytes as they stand in all), numbers that are missing in all of them, the last counts, the
/// end, marks, steps of the wall clock, which are torn, and what is wrong with any.
Result<RecordingSurvey> survey_parts(FileSystem& files, const RecordingParts& parts,
                                     const Progress& progress);

}  // namespace kinalign
