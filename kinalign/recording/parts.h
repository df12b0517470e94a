// SPDX-License-Identifier: Apache-2.0
// The files of one recording. After a disk failure a recording continues in NAME.part2.mcap, which
// begins with all data that the disk had not confirmed. Sibling files are found by their names; the
// record kinalign.recording proves that they belong together. docs/formats/recording.md.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/recording/format.h"

#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// One file of a recording. `facts` are read from its beginning and prove to which recording it
/// belongs.
struct RecordingPart {
  std::string path;
  std::optional<RecordingFacts> facts{};  // absent: a file of another program, which stands alone
};
/// Sorted by the number of the last part that a file contains.
using RecordingParts = std::vector<RecordingPart>;

/// Finds the recording to which these files belong: the files and their sibling files, except those
/// that kinalign recover has joined into one of the files. Fails if the files belong to different
/// recordings, or if the disk cannot read the beginning of a file.
Result<RecordingParts> find_parts(FileSystem& files, const std::vector<std::string>& named);

/// Returns these files and all files in the same folders whose names are those of parts, whatever
/// their content. For a link, the folder of its target is searched too.
std::vector<std::string> with_siblings(FileSystem& files, const std::vector<std::string>& named);

/// Reports a missing first part, a recording of several files (with the severity `several`), and
/// sibling files that belong to the recording by name only.
Findings judge_parts(FileSystem& files, const RecordingParts& parts, Severity several);

}  // namespace kinalign
