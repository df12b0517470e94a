// SPDX-License-Identifier: Apache-2.0
// Which of UI-PRMD's files belong together. Layout: docs/formats/kinect.md.
#pragma once

#include "kinalign/core/files.h"

#include <string>
#include <string_view>

namespace kinalign {

/// "m02_s01_e01_positions.txt", or a file of a folder Positions: the one of a pair that its user
/// names.
bool named_as_ui_prmd_positions(std::string_view path);
/// "m02_s01_e01_angles.txt": the other one.
bool named_as_ui_prmd_angles(std::string_view path);

/// The file of angles of a file of positions: by its name, in the folder Angles beside Positions or
/// in the same folder, whichever is there. Never the file itself. Fails where none is.
Result<std::string> ui_prmd_angles_of(FileSystem& files, const std::string& path);

}  // namespace kinalign
