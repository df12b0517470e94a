// SPDX-License-Identifier: Apache-2.0
// Files of a recording that lie beside one another: by what they say and by their names.
// docs/formats/recording.md.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/recording/format.h"

#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// Of the same run: parts of one recording.
bool is_same_recording(const RecordingFacts& a, const RecordingFacts& b);

/// Of a file on a bad disk.
Error unreadable_beginning(const std::string& path);

/// What a file says of itself before its messages; absent where it is no recording of ours. Fails
/// where the disk can't give the beginning.
Result<std::optional<RecordingFacts>> read_facts(FileSystem& files, const std::string& path);

/// 2 of "take.part2.mcap"; of another name 0.
int part_number(const std::string& path);

/// These and, as they lie in the same folders, all other files of their recordings. Where a file is
/// a link both its folder and the one that it leads to count.
std::vector<std::string> with_parts(FileSystem& files, const std::vector<std::string>& named);

/// As they lie in the same folders all files whose names say that they are of these recordings,
/// whatever is in them, and these.
std::vector<std::string> with_namesakes(FileSystem& files, const std::vector<std::string>& named);

/// Whether a file lies beside another and has a name of its recording's files.
bool is_namesake(const std::string& path, const std::string& other);

/// Of those beside the file that they are of its recording by their names alone, and of a folder
/// that can't be listed.
Findings judge_namesakes(FileSystem& files, const std::string& path);

}  // namespace kinalign
