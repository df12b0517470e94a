// SPDX-License-Identifier: Apache-2.0
// lab.toml: the devices of a lab, docs/recording.md. Its other tables are settings of verbs, which
// the program reads.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/take/lab.h"

#include <string_view>
#include <vector>

namespace kinalign {

/// Of the tables [device.NAME], in the order of the file; none: the text has none. `name` appears
/// in messages only. Paths that are relative become so to the folder that is in it.
Result<std::vector<DeviceOptions>> read_devices(std::string_view toml, std::string_view name);

}  // namespace kinalign
