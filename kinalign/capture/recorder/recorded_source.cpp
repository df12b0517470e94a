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
  status.heard = arrival;
  // called last, because it may close the chunk
  recorder.record(channel_, arrival, bytes, device_ns);
}

void RecordedSource::take_rate(HostTime now) {
  const SenderCounts& all = status.counts;
  // a rate over a shorter time is too inaccurate
  constexpr Duration shortest = std::chrono::milliseconds(500);
  if (!rated_ || now - *rated_ < shortest) return;
  // Samples if the source counts them, otherwise frames or, without frames, messages.
  const std::uint64_t came = status.samples > 0 ? status.samples : frames_or_messages(all);
  const std::uint64_t before = std::exchange(came_, came);
  const double elapsed_s = seconds(now - *std::exchange(rated_, now));
  status.rate_hz = came > before ? static_cast<double>(came - before) / elapsed_s : 0.0;
}

// Counts continue from take to take; a take has the difference.
StreamStatus RecordedSource::of_take() const {
  StreamStatus taken = status;
  taken.counts = since(before_, status.counts);
  return taken;
}

void RecordedSource::record_counts(Recorder& recorder, std::uint16_t counts, HostTime now) const {
  const SenderCounts taken = since(before_, status.counts);
  // A sender that sent nothing in this take is not in its counts.
  if (taken.messages == 0) return;
  recorder.record(counts, now,
                  to_json({status.topic, status.stream, status.sender, status.node, taken}));
}

}  // namespace kinalign
