// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/stream_watch.h"

#include "kinalign/io/little_endian_reader.h"

#include <numeric>

namespace kinalign {

namespace {

constexpr std::size_t most_sensors = 8;

template <class Refused>
std::uint64_t sum(const Refused& refused) {
  return std::accumulate(refused.begin(), refused.end(), std::uint64_t{0});
}

}  // namespace

StreamWatch::StreamWatch(const std::string& protocol, bool datagrams) {
  if (protocol == "noitom") decoder_.emplace<Noitom>();
  if (protocol == "xsens") decoder_.emplace<Xsens>();
  if (protocol == "kinect") decoder_.emplace<Kinect>().datagrams = datagrams;
}

void StreamWatch::feed(Noitom& noitom, std::span<const std::uint8_t> bytes) {
  noitom.frames.clear();
  noitom.decoder.feed(bytes, noitom.frames);
}

void StreamWatch::feed(Xsens& xsens, std::span<const std::uint8_t> bytes) {
  xsens.samples.clear();
  xsens.decoder.feed(bytes, xsens.samples);
}

void StreamWatch::feed(Kinect& kinect, std::span<const std::uint8_t> bytes) {
  kinect.messages.clear();
  kinect.pings.clear();
  kinect.decoder.feed(bytes, kinect.messages);
  if (kinect.datagrams) kinect.decoder.finish(kinect.messages);
  for (KinectMessage& message : kinect.messages) {
    if (const auto* ping = std::get_if<KinectPing>(&message)) kinect.pings.push_back(*ping);
    auto* frame = std::get_if<KinectFrame>(&message);
    if (frame == nullptr) continue;
    const std::uint32_t sensor = frame->origin.sensor;
    if (kinect.sensors.size() == most_sensors && !kinect.sensors.contains(sensor)) {
      ++kinect.further_sensors;
      continue;
    }
    kinect.frames.clear();
    kinect.sensors[sensor].take(std::move(*frame), kinect.frames);
    kinect.whole += static_cast<std::uint64_t>(
        std::count_if(kinect.frames.begin(), kinect.frames.end(),
                      [](const JoinedKinectFrame& one) { return one.whole; }));
  }
}

void StreamWatch::feed(std::string_view piece) {
  std::visit(
      [&](auto& decoder) {
        if constexpr (!std::is_same_v<std::decay_t<decltype(decoder)>, std::monostate>) {
          feed(decoder, octets(piece));
        }
      },
      decoder_);
}

std::span<const KinectPing> StreamWatch::pings() const {
  const auto* kinect = std::get_if<Kinect>(&decoder_);
  return kinect == nullptr ? std::span<const KinectPing>() : kinect->pings;
}

bool StreamWatch::speaks_lines() const {
  const auto* kinect = std::get_if<Kinect>(&decoder_);
  return kinect != nullptr && kinect->decoder.speaks_lines();
}

SenderCounts StreamWatch::counts(const Noitom& noitom) {
  const NoitomCounts& counts = noitom.decoder.counts();
  SenderCounts out{0, 0, counts.frames, {}, sum(counts.refused)};
  for (const auto& [index, avatar] : noitom.decoder.avatars()) {
    out.order += avatar.by_index.counts();
  }
  return out;
}

SenderCounts StreamWatch::counts(const Xsens& xsens) {
  const XsensCounts& counts = xsens.decoder.counts();
  SenderCounts out{0, 0, counts.samples, {}, sum(counts.refused)};
  for (const auto& [channel, order] : xsens.decoder.channels()) out.order += order;
  return out;
}

SenderCounts StreamWatch::counts(const Kinect& kinect) {
  SenderCounts out{
      0, 0, kinect.whole, {}, sum(kinect.decoder.counts().refused) + kinect.further_sensors};
  for (const auto& [sensor, joiner] : kinect.sensors) out.order += joiner.counts().frames;
  return out;
}

SenderCounts StreamWatch::counts() const {
  return std::visit(
      [](const auto& decoder) {
        if constexpr (std::is_same_v<std::decay_t<decltype(decoder)>, std::monostate>) {
          return SenderCounts();
        } else {
          return counts(decoder);
        }
      },
      decoder_);
}

Findings StreamWatch::findings(const std::string& name) const {
  if (const auto* noitom = std::get_if<Noitom>(&decoder_)) return noitom->decoder.findings(name);
  if (const auto* xsens = std::get_if<Xsens>(&decoder_)) return xsens->decoder.findings(name);
  return {};
}

}  // namespace kinalign
