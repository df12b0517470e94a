// SPDX-License-Identifier: Apache-2.0
// The files of what is imported: folders are searched downwards, archives are unpacked first.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/formats/archive/archive.h"

#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

struct SourceFile {
  std::string path;  // to open it
  std::string name;  // below what the user named, or a file's own: "Kinect/m01.txt"
};

/// Files of all sources, sorted by name. Names that begin with a dot are passed over, and what
/// macOS adds to archives. An archive goes to a folder of its own below `raw_folder`.
Result<std::vector<SourceFile>> list_sources(FileSystem& files,
                                             const std::vector<std::string>& sources,
                                             const std::string& raw_folder,
                                             const Progress& progress);

/// An archive's bytes out of a file.
Result<ArchiveBytes> archive_bytes(FileSystem& files, const std::string& path);

/// "m01_s01" of "Kinect/m01_s01.txt".
std::string_view stem_of(std::string_view name);
/// The name ends so, in large or small letters.
bool has_ending(std::string_view name, std::string_view ending);

}  // namespace kinalign
