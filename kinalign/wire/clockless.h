// SPDX-License-Identifier: Apache-2.0
// The exchange with a node without a counter (section 3.2 of the HFUT-MMD paper): request, answer,
// confirm. Layout: docs/formats/imu_node.md.
#pragma once

#include "kinalign/wire/node_datagram.h"
#include "kinalign/wire/node_sample.h"

namespace kinalign {

/// Sent by the node to the host.
struct ClocklessRequest {
  DatagramOrigin origin;
  bool has_battery = false;
  std::uint16_t battery_mv = 0;
  bool has_sample = false;
  NodeSample sample;  // its age is 0 if the node does not know it

  bool operator==(const ClocklessRequest&) const = default;
};

/// Stamps of the host's raw monotonic clock, ns. The host uses its own record of them; the copies
/// are only compared with it.
struct ClocklessTimes {
  std::uint32_t nonce = 0;
  std::uint64_t t2_ns = 0;  // arrival of the request
  std::uint64_t t3_ns = 0;  // departure of the answer

  bool operator==(const ClocklessTimes&) const = default;
};

/// A datagram that only carries these times.
template <DatagramType type>
struct ClocklessStamped {
  DatagramOrigin origin;  // that of the request
  ClocklessTimes times;

  bool operator==(const ClocklessStamped&) const = default;
};
/// Sent by the host to the node. It is never longer than the request.
using ClocklessAnswer = ClocklessStamped<DatagramType::answer>;
/// Sent by the node to the host at once. It contains a copy of the answer's fields.
using ClocklessConfirm = ClocklessStamped<DatagramType::confirm>;

/// Writes the datagram to the front of `out`. Empty if there is not enough space.
[[nodiscard]] std::span<const std::uint8_t> encode(const ClocklessRequest& request,
                                                   const MacKey* key, std::span<std::uint8_t> out);
template <DatagramType type>
[[nodiscard]] std::span<const std::uint8_t> encode(const ClocklessStamped<type>& stamped,
                                                   const MacKey* key, std::span<std::uint8_t> out);

/// After a refusal the last argument is default-constructed.
NodeRefusal decode(const Envelope& envelope, const MacKey* key, ClocklessRequest& request);
template <DatagramType type>
NodeRefusal decode(const Envelope& envelope, const MacKey* key, ClocklessStamped<type>& stamped);

}  // namespace kinalign
