// SPDX-License-Identifier: Apache-2.0
// Follows the sessions of one sensor by their frames. A sender that is started again begins a new
// session, and the newest session is the device. Two machines whose sensors have the same id have
// sessions that overlap. docs/formats/kinect_stream_receiver.md.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/protocols/kinect/message.h"

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>

namespace kinalign {

/// The position of a session: its latest number and ticks.
struct KinectMoment {
  KinectOrigin origin;
  std::int64_t device_ticks = 0, sent_ticks = 0;
};
KinectMoment moment_of(const KinectFrame& frame);
/// Compares the sensor's ticks, or the sender's if the sensor's have restarted: true if one of the
/// two is newer.
bool has_newer_ticks(const KinectMoment& one, const KinectMoment& than);

/// Two sessions of one sensor id at the same time: two senders.
struct KinectOverlap {
  std::uint32_t sensor = 0;
  std::array<std::string, 2> senders;  // their addresses; empty: unknown
  std::array<std::uint32_t, 2> sessions{};
};
/// The warning about two senders. `meaning`: what happens to their frames.
Finding overlap_finding(const std::string& place, const KinectOverlap& overlap,
                        const std::string& meaning);

/// The sessions of one sensor: the newest one and the 16 before it.
class KinectSessions {
 public:
  /// Takes the next frame; `sender` is its address. True if it belongs to the newest session. The
  /// first frame of an unknown session makes that session the newest one.
  bool take(const KinectMoment& moment, std::string_view sender = {});
  /// The position of the newest session; nullptr before the first frame.
  const KinectMoment* newest() const {
    return sessions_.empty() ? nullptr : &sessions_.back().latest;
  }
  /// The first two sessions found to send at the same time: the older one sent half a second of new
  /// frames after the newer one had begun.
  const std::optional<KinectOverlap>& overlap() const { return overlap_; }

 private:
  /// Addresses are kept for the warning only.
  struct Session {
    KinectMoment latest;
    std::string sender;
    std::uint32_t frames_after_end = 0;  // new frames since a newer session began
  };
  std::deque<Session> sessions_;
  std::optional<KinectOverlap> overlap_;
};

}  // namespace kinalign
