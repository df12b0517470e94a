// SPDX-License-Identifier: Apache-2.0
// Forecasts when the disk will be full, from the bytes written in the last half minute.
#pragma once

#include "kinalign/wire/time.h"

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

namespace kinalign {

/// Forecasts the time until the disk is full. Invariant: looks_ has the measurements of the last
/// half minute in their order, so the first and the last one give the rate.
class DiskForecast {
 public:
  /// The number of bytes that must stay free: for the end of the recording, its index, and the
  /// machine's own needs. On a disk that is quite full the index could not be written.
  static constexpr std::uint64_t reserve = std::uint64_t{64} << 20;

  /// Takes a measurement; called about once a second. `written`: all bytes written so far. `free`:
  /// the free bytes of the disk.
  void look(HostTime now, std::uint64_t written, std::uint64_t free);

  /// The free bytes of the disk. Empty before the first measurement.
  std::optional<std::uint64_t> free() const { return free_; }
  /// True if only the reserve is left. Recording has to end then.
  bool full() const { return free_ && *free_ <= reserve; }
  /// The minutes until only the reserve is left, at the mean rate of the last half minute. Empty if
  /// nothing is written.
  std::optional<double> minutes_left() const;
  /// True if the user must be warned: once each when 10, 5, 2 and 1 minutes are left.
  bool take_warning();

 private:
  struct Look {
    HostTime at{};
    std::uint64_t written = 0;
  };
  std::deque<Look> looks_;  // the measurements of the last half minute
  std::optional<std::uint64_t> free_;
  double warned_ = 1e9;  // minutes left at the last warning
};

/// The line "disk  12 h left at this rate, 120.5 GB; 34.2 MB in takes/03_S1A02_01.mcap". A narrow
/// terminal cuts off the end, so the least important part stands last. `bytes`: the number of bytes
/// written to the file.
std::string disk_text(const DiskForecast& forecast, std::uint64_t bytes, const std::string& path);

}  // namespace kinalign
