// SPDX-License-Identifier: Apache-2.0
// The files of an import: folders are searched recursively, archives are unpacked first.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/progress.h"
#include "kinalign/formats/archive/archive.h"

#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

struct SourceFile {
  std::string path;  // for opening it
  std::string name;  // path below the folder that the user gave: "Kinect/m01.txt"
};

/// The files of all sources, sorted by name. Files whose names begin with a dot, and files that
/// macOS adds to archives, are skipped. An archive is unpacked into its own folder below
/// `raw_folder`.
Result<std::vector<SourceFile>> list_sources(FileSystem& files,
                                             const std::vector<std::string>& sources,
                                             const std::string& raw_folder,
                                             const Progress& progress);

/// The bytes of an archive, read from a file.
Result<ArchiveBytes> archive_bytes(FileSystem& files, const std::string& path);

/// The name without folder and ending: "Kinect/m01_s01.txt" gives "m01_s01".
std::string_view stem_of(std::string_view name);
/// True if the name ends with `ending`; capital and small letters count as equal.
bool has_ending(std::string_view name, std::string_view ending);

}  // namespace kinalign
