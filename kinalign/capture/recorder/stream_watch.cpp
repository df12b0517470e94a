// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/recorder/stream_watch.h"

#include "kinalign/wire/little_endian_reader.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace kinalign {

namespace {

constexpr std::size_t most_sensors = 8;     // sensors of one sender
constexpr std::size_t most_of_a_port = 64;  // sensors of one port whose sessions are stored

template <class Refused>
std::uint64_t sum(const Refused& refused) {
  return std::accumulate(refused.begin(), refused.end(), std::uint64_t{0});
}

/// Returns the number of refused messages and skipped bytes. This sum grows with each piece that
/// has unreadable parts.
template <class Counts>
std::uint64_t trouble(const Counts& counts) {
  return sum(counts.refused) + counts.bytes_skipped;
}
std::uint64_t trouble(const KinectStreamCounts& counts) {
  return sum(counts.refused) + counts.skipped_bytes;
}

}  // namespace

StreamWatch::StreamWatch(Protocol protocol, bool datagrams, const std::string& sender) {
  switch (protocol) {
    case Protocol::noitom:
      decoder_.emplace<Noitom>().datagrams = datagrams;
      break;
    case Protocol::xsens:
      decoder_.emplace<Xsens>();
      break;
    case Protocol::kinect: {
      Kinect& kinect = decoder_.emplace<Kinect>();
      kinect.datagrams = datagrams;
      kinect.sender = sender;
      break;
    }
    case Protocol::nodes:    // RecordedNodes decodes the nodes' datagrams
    case Protocol::slimevr:  // SlimeResponder decodes the trackers' datagrams
      break;
  }
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
  // A datagram contains whole messages, so the last message ends with the datagram.
  if (kinect.datagrams) kinect.decoder.finish(kinect.messages);
  for (KinectMessage& message : kinect.messages) {
    if (const auto* ping = std::get_if<KinectPing>(&message)) kinect.pings.push_back(*ping);
    if (auto* frame = std::get_if<KinectFrame>(&message)) count(kinect, std::move(*frame), newest);
  }
}

/// Counts one frame of the newest session. If a Kinect returns through another sender, its count
/// continues.
void StreamWatch::count(Kinect& kinect, KinectFrame frame, NewestKinectFrames& newest) {
  const std::uint32_t id = frame.origin.sensor;
  const bool is_known = kinect.joiners.contains(id);
  if (!is_known && kinect.joiners.size() == most_sensors) {
    ++kinect.further_sensors;
    return;
  }
  KinectSessions alone;  // used if the port's table is full
  const bool has_room = newest.contains(id) || newest.size() < most_of_a_port;
  KinectSessions& sessions = has_room ? newest[id] : alone;
  const auto before =
      sessions.newest() != nullptr ? std::optional(*sessions.newest()) : std::nullopt;
  const bool had_overlap = sessions.overlap().has_value();
  const bool is_newest = sessions.take(moment_of(frame), kinect.sender);
  if (sessions.overlap() && !had_overlap) kinect.overlaps.push_back(*sessions.overlap());
  if (!is_newest) {
    ++kinect.late;
    return;
  }
  KinectFrameJoiner& joiner = kinect.joiners[id];
  if (!is_known && before) joiner.follow(*before);
  kinect.frames.clear();
  joiner.take(std::move(frame), kinect.frames, kinect.sender);
  kinect.whole += static_cast<std::uint64_t>(
      std::count_if(kinect.frames.begin(), kinect.frames.end(),
                    [](const JoinedKinectFrame& one) { return one.whole; }));
}

// A piece with several faults counts as refused once.
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

bool StreamWatch::has_overlap() const {
  const auto* kinect = std::get_if<Kinect>(&decoder_);
  return kinect != nullptr && !kinect->overlaps.empty();
}

// Each avatar has its own frame numbers. The losses of all avatars are added.
SenderCounts StreamWatch::counts(const Noitom& noitom) {
  const NoitomCounts& counts = noitom.decoder.counts();
  // The last frame is complete too, although the decoder waits for the frame after it.
  SenderCounts out{0, 0, counts.frames + (noitom.decoder.has_last() ? 1 : 0), {}, 0};
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

// Frames of ended sessions and outdated messages count as late. Frames whose parts contradict each
// other count as refused.
SenderCounts StreamWatch::counts(const Kinect& kinect) {
  SenderCounts out{0, 0, kinect.whole, {}, kinect.further_sensors};
  out.order.late = kinect.late;
  for (const auto& [id, joiner] : kinect.joiners) {
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
  Findings findings;
  if (const auto* kinect = std::get_if<Kinect>(&decoder_)) {
    for (const KinectOverlap& overlap : kinect->overlaps) {
      findings.push_back(
          overlap_finding(name, overlap, "both are recorded; align reads one of them"));
    }
  }
  return findings;
}

}  // namespace kinalign
