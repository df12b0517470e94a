// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/recorded_source.h"

#include <utility>

namespace kinalign {

RecordedSource::RecordedSource(Recorder& recorder, const std::string& topic, const RawChannel& raw)
    : channel_(recorder.add_channel(to_channel(topic, raw))) {
  status.stream = raw.stream;
  status.sender = raw.sender;
  status.node = raw.node;
  status.place = raw.place;
}

void RecordedSource::record(Recorder& recorder, HostTime arrival, std::string_view bytes,
                            std::optional<std::uint64_t> device_ns) {
  recorder.record(channel_, arrival, bytes, device_ns);
  ++status.counts.messages;
  status.counts.bytes += bytes.size();
  status.heard = arrival;
}

void RecordedSource::tell(Recorder& recorder, std::uint16_t counts, double elapsed_s,
                          HostTime now) {
  const SenderCounts& all = status.counts;
  const std::uint64_t frames = all.frames > 0 ? all.frames : all.messages;
  const std::uint64_t came = status.samples > 0 ? status.samples : frames;
  const std::uint64_t before = std::exchange(second_began_, came);
  status.rate_hz = came > before ? static_cast<double>(came - before) / elapsed_s : 0.0;
  recorder.record(counts, now, to_json(status.stream, status.sender, status.node, all));
}

}  // namespace kinalign
