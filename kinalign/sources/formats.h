// SPDX-License-Identifier: Apache-2.0
// The registry: which reader a file needs, by what its user says or by how it begins.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/formats/clip_survey.h"
#include "kinalign/formats/reader.h"
#include "kinalign/take/manifest.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// Makes a fresh reader for each pass over a file.
using MakeReader = std::function<Result<AnyReader>()>;
/// A first pass of a format's own, quicker than one that reads every row.
using SurveyClip = std::function<Result<ClipSurvey>(const Progress& progress)>;

struct FoundFormat {
  std::string name;  // "bvh", "trc", or a layout's
  MakeReader make;
  std::vector<std::string> further_files;  // that the reader opens itself
  SurveyClip survey;                       // empty: rows are read
};

/// Decides by `options.layout` (a format's name, a built-in layout's, or the path of a layout) or,
/// where that is empty, by `head`, the file's first bytes. Fails with the formats known.
Result<FoundFormat> find_format(FileSystem& files, const StreamOptions& options,
                                const StreamFile& file, std::string_view head);

/// What a file is, by its first bytes; a manifest, which has none of its own, by its ending .toml.
enum class FileKind : std::uint8_t {
  recording,  // MCAP
  xdf,
  take,   // HDF5
  model,  // SafeTensors
  manifest,
  stream,   // a format or a built-in layout knows it; its reader may still refuse it
  unknown,  // also an empty file; a layout that the user names may read it as a stream
};

/// Reads the file's head once. Fails where the file can't be opened or read.
Result<FileKind> kind_of_file(FileSystem& files, const std::string& path);

/// The names that `layout` may have besides paths.
std::vector<std::string_view> format_names();

}  // namespace kinalign
