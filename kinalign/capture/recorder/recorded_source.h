// SPDX-License-Identifier: Apache-2.0
// One channel of raw payloads during recording, with its counts and rate.
#pragma once

#include "kinalign/capture/recorder/past_counts.h"
#include "kinalign/capture/recorder/recorder.h"
#include "kinalign/capture/recorder/stream_status.h"
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
  /// See PastCounts.
  void remember(std::uint64_t chunk, std::uint64_t first) {
    past_.remember(chunk, first, status.counts);
  }
  /// A take begins with chunk `chunk`.
  void begin(std::uint64_t chunk) { before_ = past_.before(chunk); }
  /// Records the take's counts on the channel `counts`, if this take has a message of this source.
  void record_counts(Recorder& recorder, std::uint16_t counts, HostTime now) const;
  StreamStatus of_take() const;

  StreamStatus status;  // counts since the first message

 private:
  std::uint16_t channel_ = 0;
  std::optional<HostTime> rated_;  // time of the last rate, or of the first message
  std::uint64_t came_ = 0;         // samples, frames or messages up to that time
  /// `past_` knows the counts at each chunk that a take may begin with.
  PastCounts<SenderCounts> past_;
  SenderCounts before_;  // counts before the take
};

}  // namespace kinalign
