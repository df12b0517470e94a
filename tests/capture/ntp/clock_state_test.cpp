// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/ntp/clock_state.h"

#include <doctest/doctest.h>
#include <sys/timex.h>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

const Time now = utc_time(1'790'000'000'000'000'000);

NtpServerState state_of(const std::optional<KernelClock>& kernel,
                        std::optional<std::uint8_t> local_stratum = {},
                        const std::optional<ChronyTracking>& chrony = {}) {
  return server_state(kernel, chrony, {local_stratum, -25}, now);
}

const KernelClock synchronised{TIME_OK, STA_PLL, 12ms};

}  // namespace

TEST_CASE("fault 23 unsynchronised: leap 3 and stratum 16, unless this machine is the reference") {
  for (const std::optional<KernelClock>& kernel :
       std::initializer_list<std::optional<KernelClock>>{{},
                                                         KernelClock{TIME_ERROR, STA_UNSYNC, 16s},
                                                         KernelClock{TIME_OK, STA_UNSYNC, 1ms},
                                                         KernelClock{TIME_ERROR, 0, 1ms}}) {
    CHECK(state_of(kernel).leap == NtpLeap::unsynchronised);
    CHECK(state_of(kernel).stratum == 16);
    const NtpServerState local = state_of(kernel, 10);
    CHECK(local.leap == NtpLeap::none);
    CHECK(local.stratum == 10);
    CHECK(local.reference_id == 0x7f7f0100);
    CHECK(local.root_dispersion == 1ms);
  }
}

TEST_CASE("a synchronised clock is served as such, also where a local reference is allowed") {
  for (const auto& local : std::initializer_list<std::optional<std::uint8_t>>{{}, 10}) {
    const NtpServerState state = state_of(synchronised, local);
    CHECK(state.leap == NtpLeap::none);
    CHECK(state.stratum == 9);
    CHECK(state.reference_id == 0x7f000001);
    CHECK(state.root_dispersion == 12ms);
    CHECK(state.reference == now);
    CHECK(state.precision == -25);
  }
}

TEST_CASE("fault 22 leap_insert, leap_delete: announced on the day, no longer once it is over") {
  const auto leap = [](int state, unsigned status) {
    return state_of(KernelClock{state, status, 1ms}).leap;
  };
  CHECK(leap(TIME_OK, STA_INS) == NtpLeap::insert);
  CHECK(leap(TIME_INS, STA_INS) == NtpLeap::insert);
  CHECK(leap(TIME_DEL, STA_DEL) == NtpLeap::remove);
  CHECK(leap(TIME_OOP, STA_INS) == NtpLeap::none);
  CHECK(leap(TIME_WAIT, STA_INS) == NtpLeap::none);
  CHECK(leap(TIME_WAIT, STA_DEL) == NtpLeap::none);
  CHECK(leap(TIME_INS, STA_INS | STA_UNSYNC) == NtpLeap::unsynchronised);
}

TEST_CASE("what chronyd knows of its clock is taken over, one stratum further from the root") {
  const ChronyTracking chrony{NtpLeap::insert, 3, 5ms, 2ms, now - 30s};
  const NtpServerState state = state_of(synchronised, {}, chrony);
  CHECK(state.leap == NtpLeap::insert);
  CHECK(state.stratum == 4);
  CHECK(state.reference_id == 0x7f000001);
  CHECK(state.root_delay == 5ms);
  CHECK(state.root_dispersion == 2ms);
  CHECK(state.reference == now - 30s);
  CHECK(state.read == now);
}

TEST_CASE(
    "chronyd's word counts only where the kernel's clock follows it and it knows its distance") {
  const ChronyTracking chrony{NtpLeap::none, 3, 5ms, 2ms, now};
  CHECK(state_of(KernelClock{TIME_ERROR, STA_UNSYNC, 16s}, {}, chrony).stratum == 16);
  for (const std::uint16_t stratum : std::initializer_list<std::uint16_t>{0, 15, 16, 300}) {
    ChronyTracking lost = chrony;
    lost.stratum = stratum;
    CHECK(state_of(synchronised, {}, lost).stratum == 9);
  }
  ChronyTracking lost = chrony;
  lost.leap = NtpLeap::unsynchronised;
  CHECK(state_of(synchronised, {}, lost).stratum == 9);
  CHECK(state_of(synchronised, {}, lost).leap == NtpLeap::none);
}

TEST_CASE("this machine's kernel answers, and its clock is read in under 60 microseconds") {
  CHECK(read_kernel_clock());
  CHECK(measured_precision() <= -14);
  CHECK(measured_precision() >= -30);
}
