// SPDX-License-Identifier: Apache-2.0
// The quality of the system clock, as an NTP server must state it. It is computed from the reports
// of the kernel and of chronyd.
#pragma once

#include "kinalign/capture/ntp/chrony_tracking.h"
#include "kinalign/capture/ntp/ntp_answer.h"

#include <optional>

namespace kinalign {

/// The kernel's report about CLOCK_REALTIME, from adjtimex(2).
struct KernelClock {
  int state = 0;          // TIME_OK, TIME_INS, ...
  unsigned status = 0;    // STA_UNSYNC, STA_INS, ...
  Duration max_error{0};  // grows until the program that sets the clock resets it
};

/// Returns whether a program keeps the clock synchronised.
bool is_synchronised(const std::optional<KernelClock>& kernel);

/// Reads adjtimex(2). The result is absent if the kernel does not answer.
std::optional<KernelClock> read_kernel_clock();

/// log2 of the seconds that one reading of CLOCK_REALTIME takes (RFC 5905 section 7.3): -25 for 15
/// to 30 ns. It is rounded up, because clients add it to their error bound.
std::int8_t measured_precision();

constexpr std::uint32_t local_reference_id = 0x7f7f0100;  // 127.127.1.0, as ntpd uses

/// Choices of the user and facts about the machine that do not change while the server runs.
struct ClockPolicy {
  /// The stratum in answers while the system clock is not synchronised. This machine is then the
  /// time reference of the lab. If absent, answers say that the clock is not synchronised, and
  /// clients ignore the server.
  std::optional<std::uint8_t> local_stratum;
  /// log2 of seconds
  std::int8_t precision = -20;
};

/// Returns the state for the answers. The kernel says whether the clock is synchronised. chronyd
/// gives the distance from the primary clock; the stratum is one more than chronyd's. Without
/// chronyd the stratum is 9, since the kernel does not know it. The local stratum applies only
/// while the clock is not synchronised.
NtpServerState server_state(const std::optional<KernelClock>& kernel,
                            const std::optional<ChronyTracking>& chrony, const ClockPolicy& policy,
                            Time now);

}  // namespace kinalign
