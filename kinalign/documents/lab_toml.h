// SPDX-License-Identifier: Apache-2.0
// Reads the devices in lab.toml (docs/formats/lab_toml.md). The other tables of lab.toml contain
// options of commands, which apps/kinalign reads.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/take/lab.h"

#include <string_view>
#include <vector>

namespace kinalign {

/// Returns the devices of the tables [device.NAME], in the order of the file; empty if there are
/// none. `name` appears in messages, and relative paths become relative to its folder. Fails with
/// the line if a key is unknown, a device is not possible, or two devices use the same port.
Result<std::vector<DeviceOptions>> read_devices(std::string_view toml, std::string_view name);

}  // namespace kinalign
