// SPDX-License-Identifier: Apache-2.0
// How long a disk still takes what is recorded, from how much has come lately.
#pragma once

#include "kinalign/wire/time.h"

#include <cstdint>
#include <deque>
#include <optional>

namespace kinalign {

class DiskForecast {
 public:
  /// What is left free: the rest of the recording, its index, and the machine's own needs.
  static constexpr std::uint64_t reserve = std::uint64_t{64} << 20;

  /// Once a second or so. `written`: all bytes so far; `free`: what the disk still takes.
  void look(HostTime now, std::uint64_t written, std::uint64_t free);

  /// Absent: nobody has looked.
  std::optional<std::uint64_t> free() const { return free_; }
  /// Nothing but the reserve is left: the recording has to end.
  bool full() const { return free_ && *free_ <= reserve; }
  /// Until only the reserve is left, at the rate of the last half minute; absent: nothing comes.
  std::optional<double> minutes_left() const;
  /// Whether to warn now: at 10, 5, 2 and 1 minutes left, each once.
  bool take_warning();

 private:
  struct Look {
    HostTime at{};
    std::uint64_t written = 0;
  };
  std::deque<Look> looks_;
  std::optional<std::uint64_t> free_;
  double warned_ = 1e9;  // at so many minutes
};

}  // namespace kinalign
