// SPDX-License-Identifier: Apache-2.0
#include "firmware/host_node/pretended_clock.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

double PretendedClock::exact_us(std::int64_t raw_ns) const {
  const ClockTruth& now = truths_.back();
  return now.counter_us +
         static_cast<double>(raw_ns - now.raw_ns) * 1e-3 * (1 + now.drift_ppm * 1e-6);
}

std::uint64_t PretendedClock::counter_us(std::int64_t raw_ns) const {
  return static_cast<std::uint64_t>(std::max(0.0, std::floor(exact_us(raw_ns))));
}

void PretendedClock::set_drift(std::int64_t raw_ns, double ppm) {
  truths_.push_back({truths_.back().boot_id, raw_ns, exact_us(raw_ns), ppm});
}

void PretendedClock::step(std::int64_t raw_ns, double seconds) {
  const ClockTruth& now = truths_.back();
  truths_.push_back({now.boot_id, raw_ns, exact_us(raw_ns) + seconds * 1e6, now.drift_ppm});
}

void PretendedClock::reboot(std::int64_t raw_ns, std::uint32_t boot_id) {
  truths_.push_back({boot_id, raw_ns, 0, truths_.back().drift_ppm});
}

}  // namespace kinalign
