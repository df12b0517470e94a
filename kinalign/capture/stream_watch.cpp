// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/stream_watch.h"

#include "kinalign/io/little_endian_reader.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace kinalign {

namespace {

constexpr std::size_t most_sensors = 8;     // of a sender
constexpr std::size_t most_of_a_port = 64;  // that are remembered

template <class Refused>
std::uint64_t sum(const Refused& refused) {
  return std::accumulate(refused.begin(), refused.end(), std::uint64_t{0});
}

/// What a decoder could make nothing of: rises with each piece that has some in it.
std::uint64_t trouble(const NoitomCounts& counts) {
  return sum(counts.refused) + counts.bytes_skipped;
}
std::uint64_t trouble(const XsensCounts& counts) {
  return sum(counts.refused) + counts.bytes_skipped;
}
std::uint64_t trouble(const KinectStreamCounts& counts) {
  return sum(counts.refused) + counts.skipped_bytes;
}

/// One that was overtaken is not the newest.
void note(const KinectOrigin& origin, NewestKinectFrames& newest) {
  const auto known = newest.find(origin.sensor);
  if (known == newest.end()) {
    if (newest.size() < most_of_a_port) newest.emplace(origin.sensor, HeardKinect{origin});
    return;
  }
  HeardKinect& heard = known->second;
  const auto ahead = static_cast<std::int32_t>(origin.sequence - heard.newest.sequence);
  const bool anew = heard.newest.session != origin.session;
  if (anew) heard.over.add(heard.newest.session);
  if (anew || ahead > 0) heard.newest = origin;
}

}  // namespace

StreamWatch::StreamWatch(const std::string& protocol, bool datagrams) {
  if (protocol == "noitom") decoder_.emplace<Noitom>().datagrams = datagrams;
  if (protocol == "xsens") decoder_.emplace<Xsens>();
  if (protocol == "kinect") decoder_.emplace<Kinect>().datagrams = datagrams;
}

void StreamWatch::feed(Noitom& noitom, const Piece& piece, NewestKinectFrames&) {
  noitom.frames.clear();
  if (noitom.datagrams) {
    noitom.decoder.feed_datagram(piece.bytes, piece.arrival, noitom.frames);
  } else {
    noitom.decoder.feed(piece.bytes, noitom.frames);
  }
}

void StreamWatch::feed(Xsens& xsens, const Piece& piece, NewestKinectFrames&) {
  xsens.samples.clear();
  xsens.decoder.feed(piece.bytes, xsens.samples);
}

void StreamWatch::feed(Kinect& kinect, const Piece& piece, NewestKinectFrames& newest) {
  kinect.messages.clear();
  kinect.pings.clear();
  kinect.decoder.feed(piece.bytes, kinect.messages);
  if (kinect.datagrams) kinect.decoder.finish(kinect.messages);
  for (KinectMessage& message : kinect.messages) {
    if (const auto* ping = std::get_if<KinectPing>(&message)) kinect.pings.push_back(*ping);
    if (auto* frame = std::get_if<KinectFrame>(&message)) count(kinect, std::move(*frame), newest);
  }
}

void StreamWatch::count(Kinect& kinect, KinectFrame frame, NewestKinectFrames& newest) {
  const KinectOrigin origin = frame.origin;
  const auto before = newest.find(origin.sensor);
  const bool is_known = before != newest.end();
  if (is_known && origin.session != before->second.newest.session &&
      before->second.over.has(origin.session)) {
    ++kinect.late;
    return;
  }
  auto found = kinect.sensors.find(origin.sensor);
  if (found == kinect.sensors.end()) {
    if (kinect.sensors.size() == most_sensors) {
      ++kinect.further_sensors;
      return;
    }
    found = kinect.sensors.emplace(origin.sensor, KinectFrameJoiner()).first;
    if (is_known) found->second.follow(before->second.newest);
  }
  note(origin, newest);
  kinect.frames.clear();
  found->second.take(std::move(frame), kinect.frames);
  kinect.whole += static_cast<std::uint64_t>(
      std::count_if(kinect.frames.begin(), kinect.frames.end(),
                    [](const JoinedKinectFrame& one) { return one.whole; }));
}

void StreamWatch::feed(std::string_view piece, HostTime arrival, NewestKinectFrames& newest) {
  std::visit(
      [&](auto& decoder) {
        if constexpr (!std::is_same_v<std::decay_t<decltype(decoder)>, std::monostate>) {
          const std::uint64_t before = trouble(decoder.decoder.counts());
          feed(decoder, {octets(piece), arrival}, newest);
          if (trouble(decoder.decoder.counts()) > before) ++refused_;
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
  SenderCounts out{0, 0, counts.frames, {}, 0};
  for (const auto& [index, avatar] : noitom.decoder.avatars()) {
    out.order += avatar.by_index.counts();
  }
  return out;
}

SenderCounts StreamWatch::counts(const Xsens& xsens) {
  const XsensCounts& counts = xsens.decoder.counts();
  SenderCounts out{0, 0, counts.samples, {}, 0};
  for (const auto& [channel, order] : xsens.decoder.channels()) out.order += order;
  return out;
}

SenderCounts StreamWatch::counts(const Kinect& kinect) {
  SenderCounts out{0, 0, kinect.whole, {}, kinect.further_sensors};
  out.order.late = kinect.late;
  for (const auto& [sensor, joiner] : kinect.sensors) {
    const KinectFrameCounts joined = joiner.counts();
    out.order += joined.frames;
    out.order.late += joined.stale;
    out.refused += joined.contradicting;
  }
  return out;
}

SenderCounts StreamWatch::counts() const {
  SenderCounts all = std::visit(
      [](const auto& decoder) {
        if constexpr (std::is_same_v<std::decay_t<decltype(decoder)>, std::monostate>) {
          return SenderCounts();
        } else {
          return counts(decoder);
        }
      },
      decoder_);
  all.refused += refused_;
  return all;
}

Findings StreamWatch::findings(const std::string& name) const {
  if (const auto* noitom = std::get_if<Noitom>(&decoder_)) return noitom->decoder.findings(name);
  if (const auto* xsens = std::get_if<Xsens>(&decoder_)) return xsens->decoder.findings(name);
  return {};
}

}  // namespace kinalign
