// SPDX-License-Identifier: Apache-2.0
// UI-PRMD's Kinect v2: one text of joint offsets, one of angles. Layout: docs/formats/kinect.md.
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

/// The next piece of a text; empty at its end.
using TextPieces = std::function<Result<std::string_view>()>;

/// Fed the file of offsets; the same rows of the file of angles are taken from `angles` as they are
/// needed. Joints' places in camera space. rate_hz (30), start_ns, metres_per_unit (0.01) and up
/// are used. Rows without a counterpart are dropped with a finding.
std::unique_ptr<PointReader> make_ui_prmd_kinect_reader(const StreamOptions& options,
                                                        std::string_view offsets_file,
                                                        std::string_view angles_file,
                                                        TextPieces angles);

/// One row: offsets [22,3] in the parent's frame (the first in camera space) and angles [22,3] in
/// degrees about x, y, z, R = Rz Rx Ry, give places [22,3] in the offsets' unit.
void ui_prmd_places(std::span<const double> offsets, std::span<const double> angles,
                    std::span<double> places);

/// 66 numbers between commas, no names: both files look so.
bool looks_like_ui_prmd_kinect(std::string_view head);

}  // namespace kinalign
