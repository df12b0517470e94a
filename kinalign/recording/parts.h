// SPDX-License-Identifier: Apache-2.0
// The files of one recording. A recording continues in NAME.part2.mcap after a disk failure. That
// file begins with all data that the disk had not confirmed. docs/formats/recording.md.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/recording/part.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace kinalign {

/// Sorted by part.
using RecordingParts = std::vector<RecordingPart>;

/// The definition of a channel in any of the files, covered by a checksum. nullptr if there is
/// none.
const McapChannel* proved_channel(const RecordingParts& parts, std::uint16_t id);

/// The index of the file from which metadata or an attachment of that name is taken. The end is
/// taken from the last file that has it. Other records are taken from the first file that has them,
/// preferably one covered by checksums. parts.size() if no file has the record.
std::size_t source_of(const RecordingParts& parts, const std::string& name);

/// The index of the file that contains the highest part number; of several, the last.
std::size_t furthest(const RecordingParts& parts);

/// Returns whether another file has a better copy of this part's message: one covered by a
/// checksum, or an equally good one in a later file. The disk had not confirmed the copy in the
/// earlier file.
bool has_better(const RecordingParts& parts, std::size_t part, const McapMessage& message);

/// Returns whether a message is to be taken from another file. For programs that read one file
/// after the other. A message in two files is taken from the later file, because the disk had not
/// confirmed the earlier copy. It is taken from the earlier file if the later file ends before it
/// or is less certain.
bool stands_elsewhere(const RecordingParts& parts, std::size_t part, const McapMessage& message);

/// Reads these files once. Files that only repeat others are left out; if recover has joined the
/// parts into one of the files, these are all parts. Fails if the files do not belong to one
/// recording.
Result<RecordingParts> read_parts(FileSystem& files, const std::vector<std::string>& paths,
                                  const Progress& progress);

/// Returns the file and the files in the same folder in which its recording continues.
Result<RecordingParts> parts_from(FileSystem& files, const std::string& path,
                                  const Progress& progress);

/// Reports that the first file is not the whole recording. `PartsBehind`: whether the other files
/// were read with it.
enum class PartsBehind { left, read };
Findings judge_parts(const RecordingParts& parts, PartsBehind behind);

}  // namespace kinalign
