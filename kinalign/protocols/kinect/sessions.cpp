// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/kinect/sessions.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace kinalign {

namespace {

/// True if the session advances: by its ticks or, if these are equal, by its number.
bool goes_on(const KinectMoment& one, const KinectMoment& from) {
  const bool same_ticks =
      one.device_ticks == from.device_ticks && one.sent_ticks == from.sent_ticks;
  const auto ahead = static_cast<std::int32_t>(one.origin.sequence - from.origin.sequence);
  return same_ticks ? ahead > 0 : has_newer_ticks(one, from);
}

std::string name_of(const KinectTwins& twins, std::size_t one) {
  const std::string& sender = twins.senders.at(one);
  return fmt::format("{} in session {}", sender.empty() ? "one" : shown(sender),
                     twins.sessions.at(one));
}

}  // namespace

KinectMoment moment_of(const KinectFrame& frame) {
  return {frame.origin, frame.device_ticks, frame.sent_ticks};
}

bool has_newer_ticks(const KinectMoment& one, const KinectMoment& than) {
  return one.device_ticks > than.device_ticks || one.sent_ticks > than.sent_ticks;
}

Finding two_senders(const std::string& place, const KinectTwins& twins,
                    const std::string& meaning) {
  return {Severity::warning,
          Error{place, 0, fmt::format("one sender of Kinect sensor {}", twins.sensor),
                fmt::format("two at a time: {}, {}", name_of(twins, 0), name_of(twins, 1))},
          meaning, "give each sensor an id of its own: --sensor of its sender"};
}

/// Classifies a frame by its session, and keeps the session's position.
KinectSessions::Turn KinectSessions::hear(const KinectMoment& moment, std::string_view sender) {
  const auto* known = find(moment.origin.session);
  if (known == nullptr) {
    sessions_[count_++ % most] = {moment, std::string(sender), 0};
    spoke_last_ = moment.origin.session;
    return Turn::fresh;
  }
  Session& session = sessions_[static_cast<std::size_t>(known - sessions_.data())];
  if (goes_on(moment, session.stand)) go_on(session, moment, sender);
  if (known == &current()) return Turn::newest;
  return session.turns > 0 ? Turn::beside : Turn::over;
}

void KinectSessions::go_on(Session& session, const KinectMoment& moment, std::string_view sender) {
  session.stand = moment;
  session.sender = sender;
  const std::uint32_t before = std::exchange(spoke_last_, moment.origin.session);
  if (&session == &current() || before == spoke_last_ || session.turns == enough_turns) return;
  if (++session.turns < enough_turns) return;
  ++beside_;
  if (twins_) return;
  twins_ = KinectTwins{moment.origin.sensor,
                       {session.sender, current().sender},
                       {moment.origin.session, current().stand.origin.session}};
}

const KinectSessions::Session* KinectSessions::find(std::uint32_t session) const {
  const auto known = static_cast<std::ptrdiff_t>(std::min<std::uint64_t>(count_, most));
  const auto end = sessions_.begin() + known;
  const auto found = std::find_if(sessions_.begin(), end, [session](const Session& one) {
    return one.stand.origin.session == session;
  });
  return found == end ? nullptr : &*found;
}

const KinectMoment* KinectSessions::stand(std::uint32_t session) const {
  const Session* known = find(session);
  return known == nullptr ? nullptr : &known->stand;
}

const KinectMoment* KinectSessions::newest() const {
  return count_ == 0 ? nullptr : &current().stand;
}

bool KinectSessions::is_beside(std::uint32_t session) const {
  const Session* known = find(session);
  return known != nullptr && known->turns == enough_turns;
}

}  // namespace kinalign
