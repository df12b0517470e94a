// SPDX-License-Identifier: Apache-2.0
// The files of one recording: it goes on in NAME.part2.mcap where its disk had failed, and that one
// begins with all that the disk had not confirmed. docs/formats/recording.md.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/recording/part.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

/// In their order.
using RecordingParts = std::vector<RecordingPart>;

/// The definition of a channel that a checksum covers, in any of the files; where none does
/// nullptr.
const McapChannel* proved_channel(const RecordingParts& parts, std::uint16_t id);

/// From which file metadata or an attachment of that name are taken: the end from the last that has
/// it, all else from the first, of those that a checksum covers if there are any. parts.size()
/// where none has it.
std::size_t source_of(const RecordingParts& parts, const std::string& name);

/// The one whose messages reach furthest, in parts of the recording; of several the last.
std::size_t furthest(const RecordingParts& parts);

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

}  // namespace kinalign
