// SPDX-License-Identifier: Apache-2.0
// Finds the raw files of a take, and checks whether they have changed since the take was made.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/dataset/take_name.h"
#include "kinalign/dataset/take_summary.h"
#include "kinalign/take/manifest.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// The path of a raw file, and the name by which the take refers to it.
struct TakeInput {
  std::string name, path;
};

/// The further files that the reader of a raw file opens, for example a file of angles for a file
/// of positions. Empty if no reader is found; the build reports that.
std::vector<std::string> further_files_of(FileSystem& files, const StreamOptions& options,
                                          const StreamFile& file);

/// The raw files of a take: the files that a manifest in the folder `base` (ending in '/') names,
/// and files of `known` that only the take names. The latter are further files of readers, and
/// further files of a recording in the same folder.
std::vector<TakeInput> inputs_of(FileSystem& files, Manifest manifest, const std::string& base,
                                 const std::vector<InputFacts>& known);
/// The raw files of a take that was never built. Every file is opened to find its further files.
std::vector<TakeInput> inputs_of(FileSystem& files, Manifest manifest, const std::string& base);

/// True if each input still has the bytes from which the take was made. If an input has the same
/// length and is older than the summary, which was made at `made_ns`, the input is not read.
Result<bool> same_inputs(FileSystem& files, const std::vector<TakeInput>& inputs,
                         const TakeSummary& summary, std::int64_t made_ns,
                         const Progress& progress);

inline constexpr std::string_view raw_files_folder = "sourcedata";

/// The path of a file below the data set's folder, for example "sourcedata/s05/walk.txt", after all
/// links above the file are followed. Absent if this path is not below sourcedata/.
std::optional<std::string> place_in_sourcedata(const std::string& folder, const std::string& path);

/// True if the place is in a folder that an import unpacked: sourcedata/LABEL-HASH/.
bool is_unpacked(const std::string& place);

/// The inputs of a take, also of one that was never built. Empty if the take has no manifest. Fails
/// if the manifest can't be read.
Result<std::vector<TakeInput>> raw_files_of(FileSystem& files, const std::string& folder,
                                            const TakeName& name);

/// All files below sourcedata/; links are not followed. Fails if a folder can't be read.
Result<std::vector<std::string>> files_in_sourcedata(const std::string& folder);

}  // namespace kinalign
