// SPDX-License-Identifier: Apache-2.0
// Reads Xsens MT Manager's text export, one file for each sensor. Layout: docs/formats/imu.md.
#pragma once

#include "kinalign/formats/reader.h"
#include "kinalign/take/manifest.h"

#include <memory>
#include <string_view>

namespace kinalign {

/// Finds columns by name; the delimiter is tab , ; | : or blank. Orientation comes from Quat_q*,
/// Mat[*][*] or Roll/Pitch/Yaw, whichever most of the first 32 rows have. Acceleration comes from
/// Acc_*, with gravity, or from FreeAcc_*, without gravity, which is turned into sensor space. The
/// world (z up) becomes y up unless `up` says y. A stamp is PacketCounter / Update Rate, with the
/// counter's wraps undone, so the sensors of one recording share a time axis. Lost packets are
/// gaps. rate_hz replaces the file's rate; start_ns is the stamp of the first row. The node's name
/// is `node`. If that is empty, it is the device's id: the last eight hexadecimal digits of the
/// file name.
std::unique_ptr<ImuReader> make_xsens_text_reader(const StreamOptions& options,
                                                  std::string_view file, std::string_view node);

bool looks_like_xsens_text(std::string_view head);

}  // namespace kinalign
