// SPDX-License-Identifier: Apache-2.0
// The registry of formats: chooses a file's reader by the user's option or by the file's beginning.
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
/// A first pass of the format's own, faster than reading every row.
using SurveyClip = std::function<Result<ClipSurvey>(const Progress& progress)>;

/// The reader that was chosen for one file. `make` and `survey` keep the file system and copies of
/// the options; the file system must outlive them.
struct FoundFormat {
  std::string name;  // "bvh", "trc", or the name of a layout
  MakeReader make;
  std::vector<std::string> further_files;  // files that the reader opens itself
  SurveyClip survey;                       // empty: the survey reads all rows
};

/// Chooses by `options.layout` (the name of a format or of a built-in layout, or the path of a
/// layout); if it is empty, by `head`, the file's first bytes. The error lists the known formats.
Result<FoundFormat> find_format(FileSystem& files, const StreamOptions& options,
                                const StreamFile& file, std::string_view head);

/// The kind of a file by its first bytes; a manifest, which has no signature, by its ending .toml.
enum class FileKind : std::uint8_t {
  recording,  // MCAP
  xdf,
  take,   // HDF5
  model,  // SafeTensors
  manifest,
  stream,   // a format or a built-in layout knows it; its reader may still refuse it
  unknown,  // also an empty file; a layout that the user names may read it as a stream
};

/// Reads the beginning of the file once. Fails if the file can't be opened or read. Signatures are
/// tried first, then the ending .toml, then formats and layouts.
Result<FileKind> kind_of_file(FileSystem& files, const std::string& path);

/// The names that `layout` may have besides paths.
std::vector<std::string_view> format_names();

}  // namespace kinalign
