// SPDX-License-Identifier: Apache-2.0
// One channel of raw payloads while it is recorded, and how it does.
#pragma once

#include "kinalign/capture/recorder.h"
#include "kinalign/io/recording_format.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kinalign {

/// How a stream does: one sender's, or one node's.
struct StreamStatus {
  std::string stream, sender;
  std::string node, place;  // of nodes: the id, and where the lab says that it is worn
  SenderCounts counts;      // since it was first heard
  double rate_hz = 0.0;  // frames, where the protocol is decoded, else messages; of the last second
  HostTime heard{};      // last
  std::optional<double> battery_volts;  // where the device says that
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
