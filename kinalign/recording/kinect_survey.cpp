// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/kinect_survey.h"

#include "kinalign/protocols/protocols.h"
#include "kinalign/wire/little_endian_reader.h"

namespace kinalign {

void KinectSurvey::add(std::uint16_t channel, const RawChannel& raw) {
  if (find_recorded_protocol(raw.protocol) != Protocol::kinect) return;
  channels_.try_emplace(channel, Channel{raw, {}});
}

// Takes the frames of a message. Sensors beyond most_sensors are ignored.
void KinectSurvey::take(std::uint16_t channel, std::string_view payload) {
  const auto from = channels_.find(channel);
  if (from == channels_.end()) return;
  messages_.clear();
  from->second.decoder.feed(octets(payload), messages_);
  // A message never continues in the next datagram, so an incomplete message ends here.
  if (is_datagrams(from->second.raw.transport)) from->second.decoder.finish(messages_);
  for (const KinectMessage& message : messages_) {
    const auto* frame = std::get_if<KinectFrame>(&message);
    if (frame == nullptr) continue;
    const Sensor sensor{from->second.raw.stream, frame->origin.sensor};
    if (sensors_.size() == most_sensors && !sensors_.contains(sensor)) continue;
    sensors_[sensor].take(moment_of(*frame), from->second.raw.sender);
  }
}

Findings KinectSurvey::findings(const std::string& path) const {
  Findings findings;
  for (const auto& [sensor, sessions] : sensors_) {
    if (!sessions.overlap()) continue;
    findings.push_back(overlap_finding(path, *sessions.overlap(),
                                       "align reads one of them for " + shown(sensor.first)));
  }
  return findings;
}

}  // namespace kinalign
