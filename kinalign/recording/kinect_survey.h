// SPDX-License-Identifier: Apache-2.0
// Checks whether the Kinects of a recording have different ids. It examines only ids, numbers and
// ticks of the frames.
#pragma once

#include "kinalign/protocols/kinect/sessions.h"
#include "kinalign/protocols/kinect/stream.h"
#include "kinalign/recording/format.h"

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kinalign {

/// Follows the sessions of every sensor id. If two senders use the same id at the same time, the
/// alignment can't distinguish their frames. Little is kept of each frame, so all frames of a
/// recording can be examined.
class KinectSurvey {
 public:
  /// Adds a channel. Channels of devices other than Kinects are ignored.
  void add(std::uint16_t channel, const RawChannel& raw);
  /// Takes a message. Messages of channels that were not added are ignored.
  void take(std::uint16_t channel, std::string_view payload);
  /// Returns a finding if two senders used the same sensor id.
  Findings findings(const std::string& path) const;

 private:
  static constexpr std::size_t most_sensors = 64;
  struct Channel {
    RawChannel raw;
    KinectStreamDecoder decoder;
  };
  using Sensor = std::pair<std::string, std::uint32_t>;  // stream and sensor id

  std::map<std::uint16_t, Channel> channels_;
  std::map<Sensor, KinectSessions> sensors_;
  std::vector<KinectMessage> messages_;
};

}  // namespace kinalign
