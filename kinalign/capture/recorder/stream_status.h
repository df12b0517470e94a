// SPDX-License-Identifier: Apache-2.0
// The state of one stream while it is recorded: its counts, its rate, its sender's clock.
#pragma once

#include "kinalign/capture/net/sender_clock.h"
#include "kinalign/recording/counts.h"
#include "kinalign/wire/time.h"

#include <cstdint>
#include <optional>
#include <string>

namespace kinalign {

/// How a stream does: one sender's, or one node's.
struct StreamStatus {
  std::string topic, stream, sender;
  std::string node, place;    // of nodes: the id, and where the lab says that it is worn
  SenderCounts counts;        // of the present or last take; else since it was first heard
  std::uint64_t samples = 0;  // of nodes: a frame has several
  double rate_hz = 0.0;       // of the last second: samples, else frames, else messages
  HostTime heard{};           // last
  std::optional<double> battery_volts;  // where the device says that
  std::optional<SenderClock> clock;     // of a Kinect's sender
};

}  // namespace kinalign
