// SPDX-License-Identifier: Apache-2.0
// The list of file formats. Chooses a file's reader by the user's option, or else by the first
// bytes of the file.
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

/// Makes a new reader for each pass over a file.
using MakeReader = std::function<Result<AnyReader>()>;
/// A first pass that a format implements itself, faster than reading every row.
using SurveyClip = std::function<Result<ClipSurvey>(const Progress& progress)>;

/// The reader that was chosen for one file. `make` and `survey` keep copies of the options. They
/// also use the file system, which must outlive them.
struct FoundFormat {
  std::string name;  // "bvh", "trc", or the name of a layout
  MakeReader make;
  std::vector<std::string> further_files;  // further files that the reader opens
  SurveyClip survey;                       // empty: the first pass reads all rows
};

/// Chooses by `options.layout`: the name of a format or of a built-in layout, or the path of a
/// layout file. If it is empty, chooses by `head`, the first bytes of the file. The error lists the
/// known formats.
Result<FoundFormat> find_format(FileSystem& files, const StreamOptions& options,
                                const StreamFile& file, std::string_view head);

/// The kind of a file by its first bytes. A manifest has no signature and is recognised by its
/// ending .toml.
enum class FileKind : std::uint8_t {
  recording,  // MCAP
  xdf,
  take,   // HDF5
  model,  // SafeTensors
  manifest,
  stream,   // recognised by a format or a built-in layout; the reader may still refuse the file
  unknown,  // also an empty file; the user may name a layout that reads it as a stream
};

/// Reads the first bytes of the file. Signatures are checked first, then the ending .toml, then
/// formats and layouts. Fails if the file can't be opened or read.
Result<FileKind> kind_of_file(FileSystem& files, const std::string& path);

/// Returns the names that `layout` may have, apart from paths.
std::vector<std::string_view> format_names();

}  // namespace kinalign
