// SPDX-License-Identifier: Apache-2.0
// Finds the raw files of a take, and checks whether they are still those that it was made from.
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

/// The path of a raw file, and its name in the take.
struct TakeInput {
  std::string name, path;
};

/// The further files that the reader of a raw file opens: angles for positions, channels for
/// samples. Empty if no reader is found; the build reports that.
std::vector<std::string> further_files_of(FileSystem& files, const StreamOptions& options,
                                          const StreamFile& file);

/// The files that a manifest in `base` (ending in '/') names, and those files of `known` that only
/// the take names: further files of readers, and further files of a recording in the same folder.
std::vector<TakeInput> inputs_of(FileSystem& files, Manifest manifest, const std::string& base,
                                 const std::vector<InputFacts>& known);
/// The same for a take that was never built: every file is opened to find its further files.
std::vector<TakeInput> inputs_of(FileSystem& files, Manifest manifest, const std::string& base);

/// True if each input still has the bytes that the take was made from. An input is not read if it
/// is older than the summary, made at `made_ns`, and has the same length.
Result<bool> same_inputs(FileSystem& files, const std::vector<TakeInput>& inputs,
                         const TakeSummary& summary, std::int64_t made_ns,
                         const Progress& progress);

inline constexpr std::string_view raw_files_folder = "sourcedata";

/// The place of a file below the data set's folder, "sourcedata/s05/walk.txt", with all links above
/// the file followed. Absent if the file is not below sourcedata/ then.
std::optional<std::string> place_in_sourcedata(const std::string& folder, const std::string& path);

/// True if the place is in a folder that an import unpacked: sourcedata/LABEL-HASH/.
bool is_unpacked(const std::string& place);

/// The inputs of a take, even if it was never built. Empty without a manifest. Fails if the
/// manifest can't be read.
Result<std::vector<TakeInput>> raw_files_of(FileSystem& files, const std::string& folder,
                                            const TakeName& name);

/// All files below sourcedata/; links are not followed. Fails if a folder can't be read.
Result<std::vector<std::string>> files_in_sourcedata(const std::string& folder);

}  // namespace kinalign
