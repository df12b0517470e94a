// SPDX-License-Identifier: Apache-2.0
// The exchange of a node without a counter (section 3.2 of the HFUT-MMD paper): request, answer,
// confirm. Layout: docs/formats/imu_node.md.
#pragma once

#include "kinalign/wire/node_datagram.h"
#include "kinalign/wire/node_sample.h"

namespace kinalign {

/// Node to host.
struct ClocklessRequest {
  DatagramOrigin origin;
  bool has_battery = false;
  std::uint16_t battery_mv = 0;
  bool has_sample = false;
  NodeSample sample;  // its age is 0 where the node can't tell

  bool operator==(const ClocklessRequest&) const = default;
};

/// Stamps of the host's raw monotonic clock, ns. The host keeps its own: copies are compared alone.
struct ClocklessTimes {
  std::uint32_t nonce = 0;
  std::uint64_t t2_ns = 0;  // the request's arrival
  std::uint64_t t3_ns = 0;  // the answer's departure

  bool operator==(const ClocklessTimes&) const = default;
};

/// Host to node; never longer than the request.
struct ClocklessAnswer {
  DatagramOrigin origin;  // of the request
  ClocklessTimes times;

  bool operator==(const ClocklessAnswer&) const = default;
};

/// Node to host, sent at once: the answer's fields, copied.
struct ClocklessConfirm {
  DatagramOrigin origin;
  ClocklessTimes times;

  bool operator==(const ClocklessConfirm&) const = default;
};

std::size_t encoded_size(const ClocklessRequest& request, const MacKey* key);
std::size_t encoded_size(const ClocklessAnswer& answer, const MacKey* key);
std::size_t encoded_size(const ClocklessConfirm& confirm, const MacKey* key);

/// The datagram, at the front of `out`; empty where it has no room.
[[nodiscard]] std::span<const std::uint8_t> encode(const ClocklessRequest& request,
                                                   const MacKey* key, std::span<std::uint8_t> out);
[[nodiscard]] std::span<const std::uint8_t> encode(const ClocklessAnswer& answer, const MacKey* key,
                                                   std::span<std::uint8_t> out);
[[nodiscard]] std::span<const std::uint8_t> encode(const ClocklessConfirm& confirm,
                                                   const MacKey* key, std::span<std::uint8_t> out);

/// After a refusal the last argument is as new.
NodeRefusal decode(const Envelope& envelope, const MacKey* key, ClocklessRequest& request);
NodeRefusal decode(const Envelope& envelope, const MacKey* key, ClocklessAnswer& answer);
NodeRefusal decode(const Envelope& envelope, const MacKey* key, ClocklessConfirm& confirm);

}  // namespace kinalign
