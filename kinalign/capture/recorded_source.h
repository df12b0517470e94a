// SPDX-License-Identifier: Apache-2.0
// One channel of raw payloads while it is recorded, and how it does.
#pragma once

#include "kinalign/capture/followed_clock.h"
#include "kinalign/capture/recorder.h"
#include "kinalign/io/recording_counts.h"
#include "kinalign/io/recording_format.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kinalign {

/// How a stream does: one sender's, or one node's.
struct StreamStatus {
  std::string stream, sender;
  std::string node, place;              // of nodes: the id, and where the lab says that it is worn
  SenderCounts counts;                  // since it was first heard
  std::uint64_t samples = 0;            // of nodes: a frame has several
  double rate_hz = 0.0;                 // of the last second: samples, else frames, else messages
  HostTime heard{};                     // last
  std::optional<double> battery_volts;  // where the device says that
  std::optional<SenderClock> clock;     // of a Kinect's sender
};

class RecordedSource {
 public:
  /// A channel of its own.
  RecordedSource(Recorder& recorder, const std::string& topic, const RawChannel& raw);

  void record(Recorder& recorder, HostTime arrival, std::string_view bytes,
              std::optional<std::uint64_t> device_ns = std::nullopt);
  /// Once a second: the rate; and the counts onto the channel `counts`.
  void tell(Recorder& recorder, std::uint16_t counts, double elapsed_s, HostTime now);

  StreamStatus status;

 private:
  std::uint16_t channel_ = 0;
  std::uint64_t second_began_ = 0;  // what had come then
};

}  // namespace kinalign
