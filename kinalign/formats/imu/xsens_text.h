// SPDX-License-Identifier: Apache-2.0
// Reads text exports of Xsens MT Manager, one file per sensor. Layout: docs/formats/imu.md.
#pragma once

#include "kinalign/formats/reader.h"
#include "kinalign/take/manifest.h"

#include <memory>
#include <string_view>

namespace kinalign {

/// Reads the export of one sensor. Columns are found by name; the delimiter is tab , ; | : or
/// blank.
/// Orientation comes from Quat_q*, Mat[*][*] or Roll/Pitch/Yaw: the form that most of the first 32
/// rows have. Acceleration comes from Acc_* (with gravity) or from FreeAcc_* (without gravity),
/// which is rotated to sensor space. The world (z up) becomes y up unless the option `up` is y.
/// A stamp is PacketCounter / Update Rate, where wraps of the counter are undone. The sensors of
/// one recording therefore share a time axis. Lost packets leave gaps. The option rate_hz replaces
/// the file's rate, and start_ns is the stamp of the first row.
/// The node's name is `node`. If `node` is empty, the name is the device's id: the last eight
/// hexadecimal digits of the file name.
std::unique_ptr<ImuReader> make_xsens_text_reader(const StreamOptions& options,
                                                  std::string_view file, std::string_view node);

bool looks_like_xsens_text(std::string_view head);

}  // namespace kinalign
