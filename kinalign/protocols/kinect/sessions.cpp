// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/kinect/sessions.h"

#include "kinalign/wire/counter.h"

#include <fmt/format.h>

#include <algorithm>

namespace kinalign {

namespace {

// The newest session and 16 ended sessions are known. Without them, a frame of an ended session
// would start that session again.
constexpr std::size_t most_sessions = 17;
// Half a second of frames. Fewer frames of the old session may arrive late after a restart of the
// sender.
constexpr std::uint32_t overlapping_frames = 16;

/// True if `one` is after `from`: by its ticks or, if these are equal, by its number.
bool is_after(const KinectMoment& one, const KinectMoment& from) {
  const bool same_ticks =
      one.device_ticks == from.device_ticks && one.sent_ticks == from.sent_ticks;
  return same_ticks ? steps_between(from.origin.sequence, one.origin.sequence, 32) > 0
                    : has_newer_ticks(one, from);
}

std::string name_of(const KinectOverlap& overlap, std::size_t one) {
  const std::string& sender = overlap.senders.at(one);
  return fmt::format("{} in session {}", sender.empty() ? "one" : shown(sender),
                     overlap.sessions.at(one));
}

}  // namespace

KinectMoment moment_of(const KinectFrame& frame) {
  return {frame.origin, frame.device_ticks, frame.sent_ticks};
}

bool has_newer_ticks(const KinectMoment& one, const KinectMoment& than) {
  return one.device_ticks > than.device_ticks || one.sent_ticks > than.sent_ticks;
}

Finding overlap_finding(const std::string& place, const KinectOverlap& overlap,
                        const std::string& meaning) {
  return {Severity::warning,
          Error{place, 0, fmt::format("one sender of Kinect sensor {}", overlap.sensor),
                fmt::format("two at a time: {}, {}", name_of(overlap, 0), name_of(overlap, 1))},
          meaning, "give each sensor an id of its own: --sensor of its sender"};
}

// An unknown session means that a sender has started, so it becomes the newest session. If an older
// session keeps sending new frames, a second sender uses the same sensor id.
bool KinectSessions::take(const KinectMoment& moment, std::string_view sender) {
  const std::uint32_t session = moment.origin.session;
  const auto known =
      std::find_if(sessions_.begin(), sessions_.end(),
                   [session](const Session& one) { return one.latest.origin.session == session; });
  if (known == sessions_.end()) {
    if (sessions_.size() == most_sessions) sessions_.pop_front();
    sessions_.push_back({moment, std::string(sender)});
    return true;
  }
  Session& newest = sessions_.back();
  const bool is_newest = &*known == &newest;
  // A duplicate or late frame does not show that its sender is still running.
  if (!is_after(moment, known->latest)) return is_newest;
  known->latest = moment;
  if (!is_newest && ++known->frames_after_end == overlapping_frames && !overlap_) {
    overlap_ = {moment.origin.sensor,
                {std::string(sender), newest.sender},
                {session, newest.latest.origin.session}};
  }
  return is_newest;
}

}  // namespace kinalign
