// SPDX-License-Identifier: Apache-2.0
// Finds the files of UI-PRMD that belong together. Layout: docs/formats/kinect.md.
// The corpus has a file of positions and a file of angles for each recording, in two folders or in
// one.
#pragma once

#include "kinalign/core/files.h"

#include <string>
#include <string_view>

namespace kinalign {

/// True for "m02_s01_e01_positions.txt" or a file in a folder Positions. The user names this file
/// of a pair.
bool named_as_ui_prmd_positions(std::string_view path);
/// True for "m02_s01_e01_angles.txt" or a file in a folder Angles.
bool named_as_ui_prmd_angles(std::string_view path);

/// The file of angles for a file of positions. It has the corresponding name, and lies in the
/// folder Angles next to Positions or in the same folder. Never the file itself. Fails if there is
/// no such file.
Result<std::string> ui_prmd_angles_of(FileSystem& files, const std::string& path);

}  // namespace kinalign
