// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/kinect/frames.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace kinalign {

namespace {

constexpr std::size_t joints = kinect_joints.size();

Duration duration_of(std::int64_t ticks) { return Duration{ticks * 100}; }

/// Appends a body's joints. Returns the number of joints whose values are not finite.
std::size_t append_body(const KinectBody& body, PointFrames& out) {
  std::size_t not_finite = 0;
  for (std::size_t j = 0; j < joints; ++j) {
    const float* at = &body.positions[3 * j];
    const bool finite = std::isfinite(at[0]) && std::isfinite(at[1]) && std::isfinite(at[2]);
    const auto sent = static_cast<Tracking>(body.states[j]);
    const Tracking state = finite ? sent : Tracking::missing;
    if (!finite && sent != Tracking::missing) ++not_finite;
    out.state.push_back(state);
    for (std::size_t k = 0; k < 3; ++k) {
      out.positions.push_back(state == Tracking::missing ? 0.0 : static_cast<double>(at[k]));
    }
  }
  return not_finite;
}

// Ticks count from the sensor's start, so this stamp is not UTC. The alignment later relates the
// sensor's clock to the take's time.
Time device_stamp(const KinectFrame& frame) { return Time{duration_of(frame.device_ticks)}; }

}  // namespace

// Numbers begin again in each session. The counts of the ended session are therefore added up, and
// a new count begins.
void KinectFrameJoiner::begin_session(std::uint32_t session) {
  counts_.frames += sequence_.counts();
  sequence_ = SequenceCount(32);
  session_ = session;
  newest_.reset();
  ++counts_.sessions;
}

// The other connection's receiver joined the frame itself. Here only its number and its ticks
// matter.
void KinectFrameJoiner::follow(const KinectMoment& last) {
  begin_session(last.origin.session);
  sessions_.take(last);
  newest_ = last;
  sequence_.push(last.origin.sequence);
}

// A message of an ended session is dropped. A message of the newest session joins the open frame or
// begins a new frame. A frame is passed on as soon as all its parts have arrived.
void KinectFrameJoiner::take(KinectFrame message, std::vector<JoinedKinectFrame>& out,
                             std::string_view sender) {
  const KinectOrigin origin = message.origin;
  if (!sessions_.take(moment_of(message), sender)) {
    ++counts_.stale;
    return;
  }
  if (session_ != origin.session) {
    close(out);
    begin_session(origin.session);
  }
  if (open_ && open_->origin.sequence == origin.sequence) {
    join(std::move(message));
  } else {
    begin(std::move(message), out);
  }
  // The expected bits, one for each part up to the last: (2 << last) - 1.
  const bool whole = open_ && last_ && have_ == (2U << *last_) - 1;
  if (whole) close(out);
}

// A restarted sender sends frames with newer ticks. If the ticks are not newer, a lower number
// therefore does not mean a restart.
bool KinectFrameJoiner::is_newer(const KinectFrame& message) const {
  return newest_ && has_newer_ticks(moment_of(message), *newest_);
}

/// Begins a new frame, unless the number shows that the frame is old or the number is an outlier.
void KinectFrameJoiner::begin(KinectFrame message, std::vector<JoinedKinectFrame>& out) {
  const bool only = message.part == 0 && !message.more_parts;
  const Order order = sequence_.push(message.origin.sequence, is_newer(message));
  if (order == Order::duplicate) {
    if (!only) ++counts_.parts_late;
    return;
  }
  if (order == Order::outlier) {
    ++counts_.stale;
    return;
  }
  // A late frame is passed on, but newest_ stays: later frames are compared with the newest ticks.
  if (order != Order::late) newest_ = moment_of(message);
  close(out);
  have_ = 1U << message.part;
  last_.reset();
  if (!message.more_parts) last_ = message.part;
  open_ = std::move(message);
}

/// Adds a part to the open frame. A duplicate, or a part that contradicts the other parts, is
/// dropped.
void KinectFrameJoiner::join(KinectFrame message) {
  KinectFrame& frame = *open_;
  if ((have_ >> message.part & 1U) != 0) {
    ++counts_.parts_doubled;
    return;
  }
  // All parts of a frame have the same device ticks, and together at most six bodies. The last part
  // has the highest number.
  const bool fits = message.device_ticks == frame.device_ticks &&
                    frame.bodies.size() + message.bodies.size() <= most_kinect_bodies &&
                    (message.more_parts || std::bit_width(have_) <= message.part) &&
                    (!last_ || message.part < *last_);
  if (!fits) {
    ++counts_.contradicting;
    return;
  }
  have_ |= 1U << message.part;
  if (!message.more_parts) last_ = message.part;
  // The frame's time of sending is that of its first part, whichever part arrived first.
  frame.sent_ticks = std::min(frame.sent_ticks, message.sent_ticks);
  frame.has_hands |= message.has_hands;
  frame.has_orientations |= message.has_orientations;
  frame.bodies.insert(frame.bodies.end(), message.bodies.begin(), message.bodies.end());
}

// Passes on the open frame, complete or not.
void KinectFrameJoiner::close(std::vector<JoinedKinectFrame>& out) {
  if (!open_) return;
  const bool whole = last_ && have_ == (2U << *last_) - 1;
  if (!whole) ++counts_.parts_lost;
  open_->part = 0;
  open_->more_parts = false;
  out.push_back({std::move(*open_), whole});
  open_.reset();
}

void KinectFrameJoiner::finish(std::vector<JoinedKinectFrame>& out) { close(out); }

KinectFrameCounts KinectFrameJoiner::counts() const {
  KinectFrameCounts counts = counts_;
  counts.frames += sequence_.counts();
  // Each session after the first is a restart. The counts of a single session do not include it.
  if (counts.sessions > 1) counts.frames.restarts += counts.sessions - 1;
  return counts;
}

// Each frame gives one row. For an absent body, KinectBody{} has state 0 (missing) at every joint.
std::size_t append_kinect_row(const KinectFrame& frame, std::uint64_t body, PointFrames& out) {
  out.stamps.push_back(device_stamp(frame));
  const auto found = std::find_if(frame.bodies.begin(), frame.bodies.end(),
                                  [body](const KinectBody& one) { return one.id == body; });
  return append_body(found != frame.bodies.end() ? *found : KinectBody{}, out);
}

NodeTime kinect_sender_time(std::int64_t ticks) { return NodeTime{duration_of(ticks)}; }

// An exchange has four times, named as in NTP. T1: the sender sends the ping. T2 (`h_rx`): the ping
// arrives. T3 (`h_tx`): the host sends the pong. T4: the pong arrives. The echo in a ping contains
// T3 and T4 of an earlier pong.
Exchange exchange_of(const KinectPing& ping, HostTime h_rx, std::optional<HostTime> h_tx) {
  Exchange exchange{ping.origin.session, kinect_sender_time(ping.sent_ticks), h_rx, std::nullopt};
  if (ping.echo && h_tx) {
    exchange.echo = {kinect_sender_time(ping.echo->received_ticks), *h_tx};
  }
  return exchange;
}

Exchange exchange_of(const KinectFrame& frame, HostTime h_rx) {
  return {frame.origin.session, kinect_sender_time(frame.sent_ticks), h_rx, std::nullopt};
}

}  // namespace kinalign
