// SPDX-License-Identifier: Apache-2.0
// The files (parts) of one recording. After a disk failure a recording continues in
// NAME.part2.mcap. This file begins with all data that the disk had not confirmed. Sibling files
// are found by their names, and the record kinalign.recording proves that they belong together.
// docs/formats/recording.md.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/recording/format.h"

#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// One file of a recording. The `facts` at its beginning show to which recording it belongs.
struct RecordingPart {
  std::string path;
  std::optional<RecordingFacts> facts{};  // empty: a file of another program
};
/// The parts, sorted by the last part number that each file contains.
using RecordingParts = std::vector<RecordingPart>;

/// Finds all files of the recording to which these files belong. Siblings that kinalign recover has
/// joined into one of the files are left out. Fails if the files belong to different recordings, or
/// if the disk cannot read the beginning of a file.
Result<RecordingParts> find_parts(FileSystem& files, const std::vector<std::string>& named);

/// Returns these files and all siblings whose names are those of parts, whatever their content. For
/// a link, the folder of its target is searched, too.
std::vector<std::string> with_siblings(FileSystem& files, const std::vector<std::string>& named);

/// Returns findings about a missing first part, about a recording of several files (severity
/// `several`), and about siblings that belong to the recording by their names only.
Findings judge_parts(FileSystem& files, const RecordingParts& parts, Severity several);

}  // namespace kinalign
