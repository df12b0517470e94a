// SPDX-License-Identifier: Apache-2.0
// Finds files of the data set UI-PRMD that belong together. For each recording, the data set has a
// file of positions and a file of angles. They are in two folders or in the same folder. Layout:
// docs/formats/kinect.md.
#pragma once

#include "kinalign/core/files.h"

#include <string>
#include <string_view>

namespace kinalign {

/// True for "m02_s01_e01_positions.txt" or a file in a folder Positions. The user gives this file
/// of a pair.
bool named_as_ui_prmd_positions(std::string_view path);
/// True for "m02_s01_e01_angles.txt" or a file in a folder Angles.
bool named_as_ui_prmd_angles(std::string_view path);

/// Finds the file of angles for a file of positions. Its name differs only in the word "angles". It
/// is in the folder Angles next to Positions, or in the same folder. The result is never `path`
/// itself. Fails if there is no such file.
Result<std::string> ui_prmd_angles_of(FileSystem& files, const std::string& path);

}  // namespace kinalign
