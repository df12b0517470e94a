// SPDX-License-Identifier: Apache-2.0
// What to do about a lab that can't be recorded as it is: where it is said otherwise.
#pragma once

#include "apps/cli/console.h"

#include "kinalign/take/lab.h"

#include <cstdint>
#include <optional>
#include <set>
#include <string>

namespace kinalign {

/// What is said of a lab, and where.
struct LabSources {
  std::string file;               // with tables [device.NAME]; empty: none
  std::set<std::string> by_flag;  // devices that --device says where to find
};

/// Fails where a device's UDP port is one of those for marks: `marks`, `trigger` and, where they
/// are absent or 0, none.
Result<void> check_mark_ports(const Lab& lab, const std::optional<std::int64_t>& marks,
                              const std::optional<std::int64_t>& trigger);

/// On a port of the lab's that could not be opened: an error that begins with the device's name,
/// "marks" or "trigger".
Advice lab_port_advice(const Lab& lab, const LabSources& sources,
                       const std::optional<std::int64_t>& marks,
                       const std::optional<std::int64_t>& trigger);

/// "skeleton of [device.mocap] in lab.toml names it": on a file that could not be read.
std::string named_by(const std::string& key, const DeviceOptions& device,
                     const LabSources& sources);

}  // namespace kinalign
