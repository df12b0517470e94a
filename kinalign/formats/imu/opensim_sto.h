// SPDX-License-Identifier: Apache-2.0
// OpenSim .sto of quaternions, one column a node. Layout: docs/formats/imu.md.
#pragma once

#include "kinalign/formats/reader.h"
#include "kinalign/take/manifest.h"

#include <memory>
#include <string_view>

namespace kinalign {

/// Orientations of the nodes that the columns name ("pelvis_imu"). The world is z up, as
/// OpenSense's readers of sensor exports write it, unless `up` says y. Seconds of the time column,
/// moved so that the first row has start_ns where that is given. Other DataTypes than Quaternion
/// fail.
std::unique_ptr<ImuReader> make_opensim_sto_reader(const StreamOptions& options,
                                                   std::string_view file);

bool looks_like_opensim_sto(std::string_view head);

}  // namespace kinalign
