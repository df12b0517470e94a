// SPDX-License-Identifier: Apache-2.0
// A node's counter, made from the host's raw clock and the errors that the options ask for.
#pragma once

#include <cstdint>
#include <vector>

namespace kinalign {

/// The truth about the counter, which only a simulation knows: at raw_ns it stands at counter_us,
/// and from then on it gains drift_ppm.
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
