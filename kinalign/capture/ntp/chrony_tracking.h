// SPDX-License-Identifier: Apache-2.0
// chronyd's report about the system clock: its stratum and its distance from the primary reference
// clock. The kernel knows neither. The report uses version 6 of chrony's command protocol (candm.h
// of chrony 2 to 4).
#pragma once

#include "kinalign/wire/ntp_packet.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace kinalign {

/// The fields of chronyd's report. Their names are those of the NTP packet.
struct ChronyTracking {
  NtpLeap leap = NtpLeap::unsynchronised;
  std::uint16_t stratum = ntp_stratum_unsynchronised;
  Duration root_delay{0}, root_dispersion{0};
  Time reference{};  // time of chronyd's last update from its source
};

/// Size of the request and of the answer. They are equal, so the service can't be used for
/// amplification.
constexpr std::size_t chrony_tracking_size = 104;

std::array<std::uint8_t, chrony_tracking_size> chrony_tracking_request(std::uint32_t sequence);

/// The result is absent if the datagram is not an answer to the request with the number `sequence`.
std::optional<ChronyTracking> decode_chrony_tracking(std::span<const std::uint8_t> datagram,
                                                     std::uint32_t sequence);

}  // namespace kinalign
