// SPDX-License-Identifier: Apache-2.0
// The raw files of a take: where they lie, and whether they are still those that it was made of.
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

/// A raw file where it lies, and as the take names it.
struct TakeInput {
  std::string name, path;
};

/// The files that the reader of a raw file opens itself: angles beside positions, channels beside
/// samples. None where no reader is found: the build says that.
std::vector<std::string> further_files_of(FileSystem& files, const StreamOptions& options,
                                          const StreamFile& file);

/// The files that a manifest in `base` (ending in '/') names and, of `known`, those that
/// only the take names: what readers open beside a file, and further files of a recording, which
/// lie beside the first.
std::vector<TakeInput> inputs_of(FileSystem& files, Manifest manifest, const std::string& base,
                                 const std::vector<InputFacts>& known);
/// The same of a take that was never built: every file is opened for what its reader opens.
std::vector<TakeInput> inputs_of(FileSystem& files, Manifest manifest, const std::string& base);

/// Whether each input still has the bytes that the take was made of. One that is older than the
/// summary, made at `made_ns`, and as long as it was is not read.
Result<bool> same_inputs(FileSystem& files, const std::vector<TakeInput>& inputs,
                         const TakeSummary& summary, std::int64_t made_ns,
                         const Progress& progress);

inline constexpr std::string_view raw_files_folder = "sourcedata";

/// The place of a file below the data set's folder, "sourcedata/s05/walk.txt", with all links above
/// the file followed. Absent where the file does not lie below sourcedata/ then.
std::optional<std::string> place_in_sourcedata(const std::string& folder, const std::string& path);

/// Whether such a place lies in a folder that an import unpacked to: sourcedata/LABEL-HASH/.
bool is_unpacked(const std::string& place);

/// The inputs of a take, also of one that was never built. None where the take has no manifest.
/// Fails where the manifest can't be read.
Result<std::vector<TakeInput>> raw_files_of(FileSystem& files, const std::string& folder,
                                            const TakeName& name);

/// Everything below sourcedata/ but folders; no link is followed. Fails where a folder can't be
/// read.
Result<std::vector<std::string>> files_in_sourcedata(const std::string& folder);

}  // namespace kinalign
