// SPDX-License-Identifier: Apache-2.0
// Advice for a lab that can't be recorded as stated: it names the flag or file to change.
#pragma once

#include "apps/cli/console.h"

#include "kinalign/take/lab.h"

#include <cstdint>
#include <optional>
#include <set>
#include <string>

namespace kinalign {

/// The places that state the lab.
/// A device may be stated in a file, by a flag, or in both. The flag then changes the device of the
/// file.
struct LabSources {
  std::string file;               // the file with tables [device.NAME]; empty: none
  std::set<std::string> by_flag;  // devices that a --device flag states
};

/// Fails if a device's UDP port is also a port for marks. `marks`, `trigger`: those ports; absent
/// or 0: no fixed port.
Result<void> check_mark_ports(const Lab& lab, const std::optional<std::int64_t>& marks,
                              const std::optional<std::int64_t>& trigger);

/// Advice for a port of the lab that could not be opened. The error's file is the device's name,
/// "marks" or "trigger".
Advice lab_port_advice(const Lab& lab, const LabSources& sources,
                       const std::optional<std::int64_t>& marks,
                       const std::optional<std::int64_t>& trigger);

/// "skeleton of [device.mocap] in lab.toml names it": for a file that could not be read.
std::string named_by(const std::string& key, const DeviceOptions& device,
                     const LabSources& sources);

}  // namespace kinalign
