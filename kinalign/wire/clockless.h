// SPDX-License-Identifier: Apache-2.0
// The exchange with a node without a counter (section 3.2 of the HFUT-MMD paper). It has three
// datagrams: request, answer and confirm. Layout: docs/formats/imu_node.md.
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
  NodeSample sample;  // age_us is 0 if the node does not know the sample's age

  bool operator==(const ClocklessRequest&) const = default;
};

/// Stamps of the host's raw monotonic clock, ns. The host computes with its own record of these
/// stamps. It only compares the copies in datagrams with that record.
struct ClocklessTimes {
  std::uint32_t nonce = 0;
  std::uint64_t t2_ns = 0;  // arrival of the request
  std::uint64_t t3_ns = 0;  // departure of the answer

  bool operator==(const ClocklessTimes&) const = default;
};

/// The form of an answer and of a confirm, which contain only these times.
template <DatagramType type>
struct ClocklessStamped {
  DatagramOrigin origin;  // the origin of the request
  ClocklessTimes times;

  bool operator==(const ClocklessStamped&) const = default;
};
/// Sent by the host to the node. It is never longer than the request.
using ClocklessAnswer = ClocklessStamped<DatagramType::answer>;
/// Sent by the node to the host as soon as the answer arrives. It repeats the answer's fields.
using ClocklessConfirm = ClocklessStamped<DatagramType::confirm>;

/// Writes the datagram to the front of `out`. The result is empty if `out` is too small.
[[nodiscard]] std::span<const std::uint8_t> encode(const ClocklessRequest& request,
                                                   const MacKey* key, std::span<std::uint8_t> out);
template <DatagramType type>
[[nodiscard]] std::span<const std::uint8_t> encode(const ClocklessStamped<type>& stamped,
                                                   const MacKey* key, std::span<std::uint8_t> out);

/// If decoding is refused, the last argument is default-constructed.
NodeRefusal decode(const Envelope& envelope, const MacKey* key, ClocklessRequest& request);
template <DatagramType type>
NodeRefusal decode(const Envelope& envelope, const MacKey* key, ClocklessStamped<type>& stamped);

}  // namespace kinalign
