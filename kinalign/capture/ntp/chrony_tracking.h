// SPDX-License-Identifier: Apache-2.0
// chronyd's report about the clock that it disciplines: its stratum and its distance from the root,
// which the kernel does not know. Version 6 of chrony's command protocol (candm.h of chrony 2 to
// 4).
#pragma once

#include "kinalign/wire/ntp_packet.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace kinalign {

/// chronyd's own words for the fields of an NTP packet, in our units.
struct ChronyTracking {
  NtpLeap leap = NtpLeap::unsynchronised;
  std::uint16_t stratum = ntp_stratum_unsynchronised;
  Duration root_delay{0}, root_dispersion{0};
  Time reference{};  // time of the last update from its source
};

/// Request and answer have the same size, so the service cannot be used for amplification.
constexpr std::size_t chrony_tracking_size = 104;

std::array<std::uint8_t, chrony_tracking_size> chrony_tracking_request(std::uint32_t sequence);

/// Absent if the datagram is not an answer to the request with this number.
std::optional<ChronyTracking> decode_chrony_tracking(std::span<const std::uint8_t> datagram,
                                                     std::uint32_t sequence);

}  // namespace kinalign
