// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/recorder/recorded_source.h"

#include <utility>

namespace kinalign {

RecordedSource::RecordedSource(Recorder& recorder, const std::string& topic, const RawChannel& raw)
    : channel_(recorder.add_channel(to_channel(topic, raw))) {
  status.topic = topic;
  status.stream = raw.stream;
  status.sender = raw.sender;
  status.node = raw.node;
  status.place = raw.place;
}

void RecordedSource::record(Recorder& recorder, HostTime arrival, std::string_view bytes,
                            std::optional<std::uint64_t> device_ns) {
  if (!rated_) rated_ = arrival;
  ++status.counts.messages;
  status.counts.bytes += bytes.size();
  status.last_arrival = arrival;
  // called last, because it may close the chunk of the recording
  recorder.record(channel_, arrival, bytes, device_ns);
}

void RecordedSource::take_rate(HostTime now) {
  // a shorter time gives an inaccurate rate
  constexpr Duration shortest = std::chrono::milliseconds(500);
  if (!rated_ || now - *rated_ < shortest) return;
  // Samples if the source counts samples, otherwise frames, or messages if there are no frames.
  const std::uint64_t counted =
      status.samples > 0 ? status.samples : frames_or_messages(status.counts);
  const std::uint64_t before = std::exchange(counted_, counted);
  const double elapsed_s = seconds(now - *std::exchange(rated_, now));
  status.rate_hz = counted > before ? static_cast<double>(counted - before) / elapsed_s : 0.0;
}

}  // namespace kinalign
