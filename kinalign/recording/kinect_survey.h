// SPDX-License-Identifier: Apache-2.0
// Whether the Kinects of a recording have ids of their own: of each channel's frames, without what
// is in them.
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

class KinectSurvey {
 public:
  /// `raw`: what the channel is; of anything but a Kinect nothing is looked at.
  void add(std::uint16_t channel, const RawChannel& raw);
  void take(std::uint16_t channel, std::string_view payload);
  /// Two senders of one sensor's id.
  Findings findings(const std::string& path) const;

 private:
  static constexpr std::size_t most_sensors = 64;
  struct Way {
    RawChannel raw;
    KinectStreamDecoder decoder;
  };
  using Sensor = std::pair<std::string, std::uint32_t>;  // of a stream

  std::map<std::uint16_t, Way> ways_;
  std::map<Sensor, KinectSessions> sensors_;
  std::vector<KinectMessage> messages_;
};

}  // namespace kinalign
