// SPDX-License-Identifier: Apache-2.0
// The registry: which reader a file needs, by what its user says or by how it begins.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/formats/clip_survey.h"
#include "kinalign/formats/reader.h"
#include "kinalign/take/manifest.h"

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

/// The names that `layout` may have besides paths.
std::vector<std::string_view> format_names();

}  // namespace kinalign
