// SPDX-License-Identifier: Apache-2.0
// Reads UI-PRMD's Kinect v2 data: one text of joint offsets, one of angles. Layout:
// docs/formats/kinect.md.
// An offset is in its parent's space, so a place needs both files.
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

/// Takes the file of offsets in pieces and reads the matching rows of the file of angles from
/// `angles` as needed. Yields joint positions in camera space. Uses the options rate_hz (default
/// 30), start_ns, metres_per_unit (default 0.01) and up. Rows without a counterpart are dropped,
/// with a finding.
std::unique_ptr<PointReader> make_ui_prmd_kinect_reader(const StreamOptions& options,
                                                        std::string_view offsets_file,
                                                        std::string_view angles_file,
                                                        TextPieces angles);

/// Positions [22,3] of one row, in the offsets' unit. `offsets` [22,3] are in the parent's space,
/// the first one in camera space. `angles` [22,3] are in degrees about x, y, z; R = Rz Rx Ry.
void ui_prmd_places(std::span<const double> offsets, std::span<const double> angles,
                    std::span<double> places);

/// True if the first line has 66 numbers between commas. Both files look so.
bool looks_like_ui_prmd_kinect(std::string_view head);

}  // namespace kinalign
