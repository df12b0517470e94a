// SPDX-License-Identifier: Apache-2.0
// The kernel's stamp of a received message, from its control data (socket(7), SO_TIMESTAMPNS).
#pragma once

#include "kinalign/wire/time.h"

#include <sys/socket.h>

#include <cstring>
#include <ctime>
#include <optional>

namespace kinalign {

/// The stamp on CLOCK_REALTIME. Absent if `control` contains no stamp.
inline std::optional<Time> kernel_stamp(const cmsghdr& control) {
  if (control.cmsg_level != SOL_SOCKET || control.cmsg_type != SCM_TIMESTAMPNS) return std::nullopt;
  timespec stamp{};
  std::memcpy(&stamp, CMSG_DATA(&control), sizeof stamp);
  return Time{std::chrono::seconds(stamp.tv_sec) + Duration{stamp.tv_nsec}};
}

}  // namespace kinalign
