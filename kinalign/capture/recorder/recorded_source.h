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

/// `status` is public, because the port and the nodes update their own fields of it.
class RecordedSource {
 public:
  /// Adds a channel to the recorder.
  RecordedSource(Recorder& recorder, const std::string& topic, const RawChannel& raw);

  void record(Recorder& recorder, HostTime arrival, std::string_view bytes,
              std::optional<std::uint64_t> device_ns = std::nullopt);
  /// Call once a second. Updates the rate.
  void take_rate(HostTime now);

  StreamStatus status;  // counts since the first message

 private:
  std::uint16_t channel_ = 0;
  std::optional<HostTime> rated_;  // time of the last rate, or of the first message
  std::uint64_t counted_ = 0;      // samples, frames or messages up to that time
};

}  // namespace kinalign
