// SPDX-License-Identifier: Apache-2.0
// Forecasts the time until the disk is full, from the bytes written in the last half minute.
#pragma once

#include "kinalign/wire/time.h"

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

namespace kinalign {

/// Invariant: looks_ holds the looks of the last half minute in their order, so its ends give the
/// rate.
class DiskForecast {
 public:
  /// Bytes that stay free: for the rest of the recording, its index, and the machine's own needs.
  /// A recording whose disk is quite full could not even write its index.
  static constexpr std::uint64_t reserve = std::uint64_t{64} << 20;

  /// Called about once a second. `written`: all bytes so far; `free`: the free bytes of the disk.
  void look(HostTime now, std::uint64_t written, std::uint64_t free);

  /// Absent before the first look.
  std::optional<std::uint64_t> free() const { return free_; }
  /// Only the reserve is left: the recording has to end.
  bool full() const { return free_ && *free_ <= reserve; }
  /// The time until only the reserve is left, at the mean rate of the last half minute. Absent if
  /// nothing is written.
  std::optional<double> minutes_left() const;
  /// True if a warning is due: at 10, 5, 2 and 1 minutes left, once each.
  bool take_warning();

 private:
  struct Look {
    HostTime at{};
    std::uint64_t written = 0;
  };
  std::deque<Look> looks_;  // the looks of the last half minute
  std::optional<std::uint64_t> free_;
  double warned_ = 1e9;  // minutes left at the last warning
};

/// "disk  12 h left at this rate, 120.5 GB; 34.2 MB in takes/03_S1A02_01.mcap". The least important
/// part stands last, since a narrow terminal cuts it off. `bytes`: written to the file.
std::string disk_text(const DiskForecast& forecast, std::uint64_t bytes, const std::string& path);

}  // namespace kinalign
