// SPDX-License-Identifier: Apache-2.0
// One channel of raw payloads while it is recorded, and how it does.
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

class RecordedSource {
 public:
  /// A channel of its own.
  RecordedSource(Recorder& recorder, const std::string& topic, const RawChannel& raw);

  void record(Recorder& recorder, HostTime arrival, std::string_view bytes,
              std::optional<std::uint64_t> device_ns = std::nullopt);
  /// Once a second: the rate.
  void take_rate(HostTime now);
  /// As PastCounts has it.
  void remember(std::uint64_t chunk, std::uint64_t first) {
    past_.remember(chunk, first, status.counts);
  }
  /// A take begins with that chunk.
  void begin(std::uint64_t chunk) { before_ = past_.before(chunk); }
  /// Onto the channel `counts`, if it is heard in this take.
  void tell(Recorder& recorder, std::uint16_t counts, HostTime now) const;
  StreamStatus of_take() const;

  StreamStatus status;  // counts: since it was first heard

 private:
  std::uint16_t channel_ = 0;
  std::optional<HostTime> rated_;  // when the rate was looked at last, or the first message came
  std::uint64_t came_ = 0;         // until then
  PastCounts<SenderCounts> past_;
  SenderCounts before_;  // the take
};

}  // namespace kinalign
