// SPDX-License-Identifier: Apache-2.0
// The state of a lab during recording, for display and for the counts in a recording.
#pragma once

#include "kinalign/capture/net/sender_clock.h"
#include "kinalign/capture/nodes/node_status.h"
#include "kinalign/recording/counts.h"
#include "kinalign/wire/time.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kinalign {

/// The state of one sender's or one node's stream.
struct StreamStatus {
  std::string topic, stream, sender;
  std::string node, place;  // nodes only: the id, and the place on the body from lab.toml
  // counts of the present or last take; before the first take, since the first message
  SenderCounts counts;
  std::uint64_t samples = 0;            // nodes only, because a node's frame has several samples
  double rate_hz = 0.0;                 // samples (else frames, else messages) per second
  HostTime last_arrival{};              // arrival of the newest message
  std::optional<double> battery_volts;  // absent if the device does not send it
  std::optional<SenderClock> clock;     // senders of a Kinect only
};

/// The state of a lab at one moment.
struct LabStatus {
  HostTime now{}, begun{};  // begun: when the ports were opened
  std::vector<StreamStatus> streams;
  std::vector<NodeStatus> nodes;
  std::vector<std::pair<std::string, PortCounts>> ports{};  // by the device's name
  std::map<std::string, std::uint16_t> port_numbers{};      // by the device's name
  bool ended = false;  // this is the status at the end of a take; it omits streams without data
};

}  // namespace kinalign
