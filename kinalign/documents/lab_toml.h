// SPDX-License-Identifier: Apache-2.0
// lab.toml: the devices of a lab, docs/formats/lab_toml.md. Its other tables are settings of verbs,
// which the program reads.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/take/lab.h"

#include <string_view>
#include <vector>

namespace kinalign {

/// The devices of the tables [device.NAME], in the order of the file; empty if the text has none.
/// `name` appears in messages, and relative paths become relative to its folder.
/// An unknown key, a device without a meaning, or a port that two devices share is refused with its
/// line.
Result<std::vector<DeviceOptions>> read_devices(std::string_view toml, std::string_view name);

}  // namespace kinalign
