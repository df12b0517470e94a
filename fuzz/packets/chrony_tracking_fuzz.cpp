// SPDX-License-Identifier: Apache-2.0
// For any answer of chrony the values are in the range that NTP allows.
#include "kinalign/capture/ntp/clock_state.h"

#include <cstdlib>

using namespace kinalign;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto tracking = decode_chrony_tracking({data, size}, 0x01020304);
  if (!tracking) return 0;
  const KernelClock kernel{0, 0, Duration{0}};
  const NtpServerState state = server_state(kernel, tracking, ClockPolicy{}, tracking->reference);
  const bool whole = state.stratum >= 1 && state.stratum < ntp_stratum_unsynchronised &&
                     state.root_delay >= Duration{0} && state.root_dispersion >= Duration{0};
  if (!whole || ntp_from_time(state.reference).bits == 0) std::abort();
  return 0;
}
