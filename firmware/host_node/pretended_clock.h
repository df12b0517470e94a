// SPDX-License-Identifier: Apache-2.0
// A node's counter, made from the host's raw clock by what shall be wrong with it.
#pragma once

#include <cstdint>
#include <vector>

namespace kinalign {

/// From raw_ns on the counter stands at counter_us and gains drift_ppm: what nobody but a
/// simulation knows.
struct ClockTruth {
  std::uint32_t boot_id = 0;
  std::int64_t raw_ns = 0;
  double counter_us = 0;
  double drift_ppm = 0;
};

class PretendedClock {
 public:
  explicit PretendedClock(const ClockTruth& start) : truths_{start} {}

  std::uint64_t counter_us(std::int64_t raw_ns) const;
  void set_drift(std::int64_t raw_ns, double ppm);
  void step(std::int64_t raw_ns, double seconds);
  void reboot(std::int64_t raw_ns, std::uint32_t boot_id);
  const std::vector<ClockTruth>& truths() const { return truths_; }

 private:
  double exact_us(std::int64_t raw_ns) const;

  std::vector<ClockTruth> truths_;
};

}  // namespace kinalign
