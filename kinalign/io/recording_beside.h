// SPDX-License-Identifier: Apache-2.0
// Files of a recording that lie beside one another: by what they say and by their names.
// docs/formats/recording.md.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/io/recording_format.h"

#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// Of the same run: parts of one recording.
bool is_same_recording(const RecordingFacts& a, const RecordingFacts& b);

/// What a file says of itself before its messages; absent where it is no recording of ours.
Result<std::optional<RecordingFacts>> read_facts(FileSystem& files, const std::string& path);

struct FileBeside {
  std::string path;
  int part = 0;
};
/// Files of the same recording in the same folder, itself among them.
std::vector<FileBeside> files_beside(FileSystem& files, const std::string& path,
                                     const RecordingFacts& facts);

/// These and, as they lie in the same folders, all other files of their recordings.
std::vector<std::string> with_parts(FileSystem& files, const std::vector<std::string>& named);

/// As they lie in the same folders all files whose names say that they are of these recordings,
/// whatever is in them, and these.
std::vector<std::string> with_namesakes(FileSystem& files, const std::vector<std::string>& named);

/// Of those beside the file that they are of its recording by their names alone.
Findings judge_namesakes(FileSystem& files, const std::string& path);

}  // namespace kinalign
