// SPDX-License-Identifier: Apache-2.0
// Reads the Kinect v2 data of the data set UI-PRMD. A recording has one text file of joint offsets
// and one of angles. An offset is in the space of the joint's parent, so both files are needed for
// a position. Layout: docs/formats/kinect.md.
#pragma once

#include "kinalign/formats/reader.h"
#include "kinalign/take/manifest.h"

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <string_view>

namespace kinalign {

constexpr std::size_t ui_prmd_joints = 22;

/// Returns the next piece of a text; empty at its end.
using TextPieces = std::function<Result<std::string_view>()>;

/// Makes a reader that takes the file of offsets in pieces. It reads the matching rows of the file
/// of angles from `angles` when it needs them. The rows are joint positions in camera space. The
/// options are rate_hz (default 30), start_ns, metres_per_unit (default 0.01) and up. Rows that
/// only one file has are dropped with a finding.
std::unique_ptr<PointReader> make_ui_prmd_kinect_reader(const StreamOptions& options,
                                                        std::string_view offsets_file,
                                                        std::string_view angles_file,
                                                        TextPieces angles);

/// Computes positions [22,3] of one row, in the unit of the offsets. `offsets` [22,3]: in the
/// parent's space, the first one in camera space. `angles` [22,3]: degrees about x, y, z; R = Rz Rx
/// Ry.
void ui_prmd_places(std::span<const double> offsets, std::span<const double> angles,
                    std::span<double> places);

/// True if the first line has 66 numbers with commas between them. Both files have this form.
bool looks_like_ui_prmd_kinect(std::string_view head);

}  // namespace kinalign
