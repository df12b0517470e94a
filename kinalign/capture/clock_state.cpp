// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/clock_state.h"

#include <sys/timex.h>

#include <algorithm>
#include <cmath>
#include <ctime>

namespace kinalign {

namespace {

/// Leap 1 or 2 on the day of the leap second, before it: the kernel leaves its bits standing
/// behind it.
NtpLeap leap_of(const KernelClock& kernel) {
  if (kernel.state == TIME_OOP || kernel.state == TIME_WAIT) return NtpLeap::none;
  if ((kernel.status & STA_INS) != 0) return NtpLeap::insert;
  return (kernel.status & STA_DEL) != 0 ? NtpLeap::remove : NtpLeap::none;
}

bool is_synchronised(const KernelClock& kernel) {
  return (kernel.status & STA_UNSYNC) == 0 && kernel.state != TIME_ERROR;
}

}  // namespace

std::optional<KernelClock> read_kernel_clock() {
  timex asked{};
  const int state = ::adjtimex(&asked);
  if (state < 0) return std::nullopt;
  return KernelClock{state, static_cast<unsigned>(asked.status),
                     std::chrono::microseconds(asked.maxerror)};
}

std::int8_t measured_precision() {
  constexpr int readings = 1000;
  timespec first{}, last{};
  ::clock_gettime(CLOCK_REALTIME, &first);
  for (int i = 0; i < readings; ++i) ::clock_gettime(CLOCK_REALTIME, &last);
  const double s = static_cast<double>(last.tv_sec - first.tv_sec) +
                   1e-9 * static_cast<double>(last.tv_nsec - first.tv_nsec);
  // a step of the clock between the readings is no reading time
  return static_cast<std::int8_t>(std::ceil(std::log2(std::clamp(s / readings, 1e-9, 1e-3))));
}

NtpServerState server_state(const std::optional<KernelClock>& kernel, const ClockPolicy& policy,
                            Time now) {
  constexpr std::uint8_t synchronised_stratum = 9;
  NtpServerState state;
  state.precision = policy.precision;
  state.reference = state.read = now;
  if (kernel && is_synchronised(*kernel)) {
    state.leap = leap_of(*kernel);
    state.stratum = synchronised_stratum;
    state.reference_id = 0x7f000001;  // 127.0.0.1: a program on this host sets the clock
    state.root_dispersion = kernel->max_error;
  } else if (policy.local_stratum) {
    state.leap = NtpLeap::none;
    state.stratum = *policy.local_stratum;
    state.reference_id = local_reference_id;
    state.root_dispersion = std::chrono::milliseconds(1);
  }
  return state;
}

}  // namespace kinalign
