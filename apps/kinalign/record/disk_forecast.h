// SPDX-License-Identifier: Apache-2.0
// How long a disk still takes what is recorded, from how much has come lately.
#pragma once

#include "kinalign/wire/time.h"

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

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
  /// Until only the reserve is left, at the rate of the fastest five seconds of the last half
  /// minute: who begins counts soon, and who sends by fits and starts is not forgotten between
  /// them. Absent: nothing comes.
  std::optional<double> minutes_left() const;
  /// Whether to warn now: at 10, 5, 2 and 1 minutes left, each once.
  bool take_warning();

 private:
  struct Look {
    HostTime at{};
    std::uint64_t written = 0;
    double rate = 0.0;  // bytes/s over the five seconds before; 0: nobody had looked for so long
  };
  std::deque<Look> looks_;  // of the last half minute
  double rate_ = 0.0;       // bytes/s
  std::optional<std::uint64_t> free_;
  double warned_ = 1e9;  // at so many minutes
};

/// "disk  12 h left at this rate, 120.5 GB; 34.2 MB in takes/03_S1A02_01.mcap": what may be cut off
/// on a narrow terminal stands last. `bytes`: in the file.
std::string disk_text(const DiskForecast& forecast, std::uint64_t bytes, const std::string& path);

}  // namespace kinalign
