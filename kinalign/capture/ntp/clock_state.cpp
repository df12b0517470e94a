// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/ntp/clock_state.h"

#include "kinalign/capture/net/host_clock.h"

#include <sys/timex.h>

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

/// Leap 1 or 2 announces a leap second on the day before it happens. The kernel keeps its status
/// bits after the leap second, so its state is checked first.
NtpLeap leap_of(const KernelClock& kernel) {
  if (kernel.state == TIME_OOP || kernel.state == TIME_WAIT) return NtpLeap::none;
  if ((kernel.status & STA_INS) != 0) return NtpLeap::insert;
  return (kernel.status & STA_DEL) != 0 ? NtpLeap::remove : NtpLeap::none;
}

// A report with stratum 0 is not usable. chronyd's stratum plus one must still be a valid stratum.
bool knows_its_distance(const std::optional<ChronyTracking>& chrony) {
  return chrony && chrony->leap != NtpLeap::unsynchronised && chrony->stratum > 0 &&
         chrony->stratum < ntp_stratum_unsynchronised - 1;
}

// If chronyd gives no usable report, the stratum is a guess, and the kernel's maximum error is the
// root dispersion.
void set_synchronised(NtpServerState& state, const KernelClock& kernel,
                      const std::optional<ChronyTracking>& chrony) {
  constexpr std::uint8_t unknown_stratum = 9;
  state.reference_id = 0x7f000001;  // 127.0.0.1: a program on this host sets the clock
  state.leap = leap_of(kernel);
  state.stratum = unknown_stratum;
  state.root_dispersion = kernel.max_error;
  if (!knows_its_distance(chrony)) return;
  state.leap = chrony->leap;
  state.stratum = static_cast<std::uint8_t>(chrony->stratum + 1);
  state.root_delay = chrony->root_delay;
  state.root_dispersion = chrony->root_dispersion;
  state.reference = chrony->reference;
}

}  // namespace

bool is_synchronised(const std::optional<KernelClock>& kernel) {
  return kernel && (kernel->status & STA_UNSYNC) == 0 && kernel->state != TIME_ERROR;
}

std::optional<KernelClock> read_kernel_clock() {
  timex asked{};
  const int state = ::adjtimex(&asked);
  if (state < 0) return std::nullopt;
  return KernelClock{state, static_cast<unsigned>(asked.status),
                     std::chrono::microseconds(asked.maxerror)};
}

// One reading is too short to be timed, so a thousand readings are timed together.
std::int8_t measured_precision() {
  constexpr int readings = 1000;
  SystemClocks clocks;
  const Time first = clocks.utc();
  Time last = first;
  for (int i = 0; i < readings; ++i) last = clocks.utc();
  const double s = seconds(last - first);
  // the limits guard against a clock step between the readings
  return static_cast<std::int8_t>(std::ceil(std::log2(std::clamp(s / readings, 1e-9, 1e-3))));
}

NtpServerState server_state(const std::optional<KernelClock>& kernel,
                            const std::optional<ChronyTracking>& chrony, const ClockPolicy& policy,
                            Time now) {
  NtpServerState state;
  state.precision = policy.precision;
  state.reference = state.read = now;
  if (is_synchronised(kernel)) {
    set_synchronised(state, *kernel, chrony);
  } else if (policy.local_stratum) {
    // No program sets the clock, and the user has made this machine the lab's reference. Its
    // distance from UTC is unknown; 1 ms is stated.
    state.leap = NtpLeap::none;
    state.stratum = *policy.local_stratum;
    state.reference_id = local_reference_id;
    state.root_dispersion = std::chrono::milliseconds(1);
  }
  return state;
}

}  // namespace kinalign
