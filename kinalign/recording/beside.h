// SPDX-License-Identifier: Apache-2.0
// Finds sibling files: the files of one recording in one folder, by their content and by their
// names. docs/formats/recording.md.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/recording/format.h"

#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// Returns whether two files are parts of one recording: they are from the same run.
bool is_same_recording(const RecordingFacts& a, const RecordingFacts& b);

/// The error for a file whose beginning the disk cannot read.
Error unreadable_beginning(const std::string& path);

/// Reads the facts that stand before the messages of a file. Absent if the file is not a recording
/// of kinalign. Fails if the disk cannot read the beginning.
Result<std::optional<RecordingFacts>> read_facts(FileSystem& files, const std::string& path);

/// The number in a file name: 2 in "take.part2.mcap", 0 in a name without one.
int part_number(const std::string& path);

/// Returns these files and all other files of their recordings in the same folders. For a link,
/// both its folder and the folder of its target are searched.
std::vector<std::string> with_parts(FileSystem& files, const std::vector<std::string>& named);

/// Returns these files and all files in the same folders whose names say that they belong to these
/// recordings, whatever their content.
std::vector<std::string> with_namesakes(FileSystem& files, const std::vector<std::string>& named);

/// Returns whether a file lies in the folder of another and has a name of the same recording.
bool is_namesake(const std::string& path, const std::string& other);

/// Reports sibling files that belong to the recording by name only, and folders that cannot be
/// listed.
Findings judge_namesakes(FileSystem& files, const std::string& path);

}  // namespace kinalign
