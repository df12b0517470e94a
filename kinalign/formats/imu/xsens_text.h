// SPDX-License-Identifier: Apache-2.0
// Xsens MT Manager's text export, one file a sensor. Layout: docs/formats/imu.md.
#pragma once

#include "kinalign/formats/reader.h"
#include "kinalign/take/manifest.h"

#include <memory>
#include <string_view>

namespace kinalign {

/// Columns by name, delimiter tab , ; | : or blank. Orientation from Quat_q*, Mat[*][*] or
/// Roll/Pitch/Yaw, the first of these with a value in the first 32 rows; acceleration from Acc_*
/// (gravity in), else from FreeAcc_* brought into the sensor's space (gravity out). The world (z
/// up) becomes y up unless `up` says y. A stamp is PacketCounter / Update Rate, without its wraps,
/// so sensors of one recording share their axis; lost packets are gaps. rate_hz replaces the file's
/// rate, start_ns is the stamp of the first row. The node is called `node` or, where that is empty,
/// by the device's id, the file name's last eight hexadecimal digits.
std::unique_ptr<ImuReader> make_xsens_text_reader(const StreamOptions& options,
                                                  std::string_view file, std::string_view node);

bool looks_like_xsens_text(std::string_view head);

}  // namespace kinalign
