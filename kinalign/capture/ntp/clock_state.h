// SPDX-License-Identifier: Apache-2.0
// How good the system's clock is, from what the kernel and chronyd say of it, as an NTP server has
// to state it.
#pragma once

#include "kinalign/capture/ntp/chrony_tracking.h"
#include "kinalign/capture/ntp/ntp_answer.h"

#include <optional>

namespace kinalign {

/// The kernel's word on CLOCK_REALTIME, as adjtimex(2) gives it.
struct KernelClock {
  int state = 0;          // TIME_OK, TIME_INS, ...
  unsigned status = 0;    // STA_UNSYNC, STA_INS, ...
  Duration max_error{0};  // grows until whoever disciplines the clock sets it anew
};

/// Something disciplines it.
bool is_synchronised(const std::optional<KernelClock>& kernel);

/// None where the kernel does not answer.
std::optional<KernelClock> read_kernel_clock();

/// log2 of the seconds that one reading of CLOCK_REALTIME takes, rounded up, as RFC 5905 section
/// 7.3 has it: -25 where that is 15 to 30 ns. Not cut: whoever reads it adds it to an error.
std::int8_t measured_precision();

constexpr std::uint32_t local_reference_id = 0x7f7f0100;  // 127.127.1.0, as ntpd has it

struct ClockPolicy {
  /// What answers state where the system's clock is not synchronised: this machine is then the
  /// lab's reference. None: that it is not synchronised, and clients turn away.
  std::optional<std::uint8_t> local_stratum;
  std::int8_t precision = -20;
};

/// Whether the clock is synchronised is the kernel's word. How far it is from the root is
/// chronyd's, one stratum below it; without one the stratum is 9, since the kernel knows none. A
/// local reference is one only while nothing disciplines the clock.
NtpServerState server_state(const std::optional<KernelClock>& kernel,
                            const std::optional<ChronyTracking>& chrony, const ClockPolicy& policy,
                            Time now);

}  // namespace kinalign
