// SPDX-License-Identifier: Apache-2.0
// One channel of raw payloads during recording, with its counts and rate.
#pragma once

#include "kinalign/capture/recorder/lab_status.h"
#include "kinalign/capture/recorder/recorder.h"
#include "kinalign/recording/format.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kinalign {

/// `status` is public, because RecordedPort and RecordedNodes update some of its fields.
class RecordedSource {
 public:
  /// Adds a channel to the recorder.
  RecordedSource(Recorder& recorder, const std::string& topic, const RawChannel& raw);

  /// Records one payload. `device_ns`: stamp of the device's own clock, ns.
  void record(Recorder& recorder, HostTime arrival, std::string_view bytes,
              std::optional<std::uint64_t> device_ns = std::nullopt);
  /// Call once a second. Updates the rate.
  void take_rate(HostTime now);

  StreamStatus status;  // counts since the first message

 private:
  std::uint16_t channel_ = 0;
  std::optional<HostTime> rated_;  // time of the last rate; before that, of the first message
  std::uint64_t counted_ = 0;      // samples, frames or messages at that time
};

}  // namespace kinalign
