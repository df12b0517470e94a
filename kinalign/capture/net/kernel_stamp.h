// SPDX-License-Identifier: Apache-2.0
// When the kernel had something in hands, as it says beside the bytes (socket(7), SO_TIMESTAMPNS).
#pragma once

#include "kinalign/wire/time.h"

#include <sys/socket.h>

#include <cstring>
#include <ctime>
#include <optional>

namespace kinalign {

/// On CLOCK_REALTIME; absent where `control` says something else.
inline std::optional<Time> kernel_stamp(const cmsghdr& control) {
  if (control.cmsg_level != SOL_SOCKET || control.cmsg_type != SCM_TIMESTAMPNS) return std::nullopt;
  timespec stamp{};
  std::memcpy(&stamp, CMSG_DATA(&control), sizeof stamp);
  return Time{std::chrono::seconds(stamp.tv_sec) + Duration{stamp.tv_nsec}};
}

}  // namespace kinalign
