// SPDX-License-Identifier: Apache-2.0
// Follows the sessions of one sensor id. Each start of a sender begins a new session, and only the
// newest session counts as the device. If two machines use the same sensor id, their sessions
// overlap. docs/formats/kinect_stream_receiver.md.
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
/// Compares the sensor's ticks and the sender's ticks, because the sensor's ticks may have
/// restarted. True if one of the two is newer.
bool has_newer_ticks(const KinectMoment& one, const KinectMoment& than);

/// Two sessions with the same sensor id at the same time. This means two senders.
struct KinectOverlap {
  std::uint32_t sensor = 0;
  std::array<std::string, 2> senders;  // their addresses; empty if unknown
  std::array<std::uint32_t, 2> sessions{};
};
/// The warning about two senders. `meaning`: the consequence for their frames.
Finding overlap_finding(const std::string& place, const KinectOverlap& overlap,
                        const std::string& meaning);

/// The sessions of one sensor: the newest one and the 16 before it.
class KinectSessions {
 public:
  /// Takes the next frame from the address `sender`. Returns true if the frame belongs to the
  /// newest session. The first frame of an unknown session makes that session the newest one.
  bool take(const KinectMoment& moment, std::string_view sender = {});
  /// The position of the newest session; nullptr before the first frame.
  const KinectMoment* newest() const {
    return sessions_.empty() ? nullptr : &sessions_.back().latest;
  }
  /// The first two sessions that sent at the same time. The older session sent half a second of new
  /// frames after the newer session had begun.
  const std::optional<KinectOverlap>& overlap() const { return overlap_; }

 private:
  /// The address serves the warning only.
  struct Session {
    KinectMoment latest;
    std::string sender;
    std::uint32_t frames_after_end = 0;  // new frames since a newer session began
  };
  std::deque<Session> sessions_;
  std::optional<KinectOverlap> overlap_;
};

}  // namespace kinalign
