// SPDX-License-Identifier: Apache-2.0
// The state of one stream during recording: its counts, its rate and its sender's clock.
#pragma once

#include "kinalign/capture/net/sender_clock.h"
#include "kinalign/recording/counts.h"
#include "kinalign/wire/time.h"

#include <cstdint>
#include <optional>
#include <string>

namespace kinalign {

/// The state of one sender's or one node's stream.
/// Made for display and for the counts in a recording.
struct StreamStatus {
  std::string topic, stream, sender;
  std::string node, place;  // nodes only: the id, and the place on the body from lab.toml
  // of the present or last take; before the first take, since the first message
  SenderCounts counts;
  std::uint64_t samples = 0;            // nodes only: a frame has several samples
  double rate_hz = 0.0;                 // of the last second: samples, or frames, or messages
  HostTime heard{};                     // last arrival
  std::optional<double> battery_volts;  // absent if the device does not send it
  std::optional<SenderClock> clock;     // senders of a Kinect only
};

}  // namespace kinalign
