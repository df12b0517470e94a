// SPDX-License-Identifier: Apache-2.0
// The seed's random stream 122 gives the delay of the sender's program for each frame; the counter
// is the frame's number and the lane is 0. The seed mixed with 122 gives the sender's clock.
#include "apps/kinalign/simulate/live_camera.h"

#include "apps/kinalign/simulate/live_suit.h"

#include "kinalign/protocols/kinect/binary.h"
#include "kinalign/protocols/kinect/stream.h"

#include <algorithm>
#include <array>

namespace kinalign {

namespace {

using namespace std::chrono_literals;

constexpr Duration hello_period = 1s, ping_period = 200ms;  // docs/formats/kinect_stream.md
// The id of the body. It is above 2^53, like the ids from the Kinect's SDK.
constexpr std::uint64_t body_id = 72'057'594'037'927'936 + 1;

/// The body that the sensor saw in a frame. Empty if no joint was found.
std::optional<KinectBody> body_of(const PointFrames& frames, std::size_t frame) {
  KinectBody body;
  body.id = body_id;
  bool seen = false;
  for (std::size_t j = 0; j < kinect_joint_count; ++j) {
    const std::size_t i = frame * kinect_joint_count + j;
    // In both arrays i is the index of joint j in this frame; positions are in metres.
    body.states[j] = static_cast<std::uint8_t>(frames.state[i]);
    seen |= frames.state[i] != Tracking::missing;
    for (std::size_t k = 0; k < 3; ++k) {
      body.positions[3 * j + k] = static_cast<float>(frames.positions[3 * i + k]);
    }
  }
  return seen ? std::optional(body) : std::nullopt;
}

}  // namespace

LiveCamera::LiveCamera(const Rehearsal& rehearsal, const LiveCameraOptions& options,
                       ClockReader& clock, LiveSocket socket)
    : rehearsal_(rehearsal),
      clock_(clock),
      random_(options.seed, 122),
      sender_(mix64(options.seed ^ 122), options.length_s),
      start_(options.start),
      next_hello_(options.start),
      next_ping_(options.start),
      end_(options.start + from_seconds(options.length_s)),
      session_(options.session),
      socket_(std::move(socket)) {}

// Pongs are received first, so that the stamp of their arrival is as early as possible.
void LiveCamera::work() {
  receive();
  const HostTime now = clock_.raw();
  // After a delay every missed hello and ping is still sent, so that their numbers have no gap.
  for (; next_hello_ <= std::min(now, end_); next_hello_ += hello_period) send_hello();
  for (; next_ping_ <= std::min(now, end_); next_ping_ += ping_period) send_ping();
  for (HostTime due = frame_due(); due <= now; due = frame_due()) {
    // If this program wakes up late, the frame is delayed; the summary reports the worst delay.
    worst_late_ = std::max(worst_late_, now - due);
    send_frame();
  }
}

HostTime LiveCamera::next() const {
  HostTime next = frame_due();
  if (next_hello_ <= end_) next = std::min(next, next_hello_);
  if (next_ping_ <= end_) next = std::min(next, next_ping_);
  return next;
}

/// The time at which the next frame is sent: the time of its measurement plus the delay of the
/// sender's program.
HostTime LiveCamera::frame_due() const {
  if (frame_ >= rehearsal_.ticks.size()) return HostTime::max();
  const double s = rehearsal_.ticks[frame_].seconds + program_delay_s(random_, frame_);
  return start_ + from_seconds(s);
}

/// Receives pongs. The next ping repeats the data of the latest pong.
void LiveCamera::receive() {
  std::array<std::uint8_t, 64> room{};  // a pong has 36 bytes
  for (std::size_t size = socket_.receive(room); size > 0; size = socket_.receive(room)) {
    // The arrival of each pong is stamped before the pong is decoded.
    const std::int64_t received = sender_ticks(clock_.raw());
    KinectMessage message;
    if (decode_kinect_datagram(std::span(room).first(size), message) != KinectRefusal::none)
      continue;
    const auto* pong = std::get_if<KinectPong>(&message);
    // A pong with another session number answers an earlier run on the same port.
    if (pong == nullptr || pong->origin.session != session_) continue;
    echo_ = KinectEcho{pong->pong_sequence, pong->nonce, received};
  }
}

/// Sends the next frame. The frame has no body if the sensor saw none.
void LiveCamera::send_frame() {
  const KinectTick& tick = rehearsal_.ticks[frame_];
  KinectFrame frame;
  frame.origin = {1, session_, static_cast<std::uint32_t>(tick.number)};
  frame.device_ticks = tick.device;
  // A frame has two stamps of the sender's clock: when it was due and when it is sent.
  frame.taken_ticks = sender_ticks(frame_due());
  // The frame also has the time of the wall clock, in microseconds.
  frame.utc_us = to_ns(clock_.utc()) / 1000;
  if (auto body = body_of(rehearsal_.kinect, frame_)) frame.bodies.push_back(*body);
  frame.sent_ticks = sender_ticks(clock_.raw());
  if (send(frame)) ++sent_;
  // If the system refuses the datagram, the frame is lost: a camera does not repeat a frame.
  ++frame_;
}

void LiveCamera::send_hello() { send(KinectHello{origin(hellos_), "simulated", "kinalign"}); }

void LiveCamera::send_ping() {
  KinectPing ping{origin(pings_), 0, echo_};
  // The time is read directly before the datagram is sent.
  ping.sent_ticks = sender_ticks(clock_.raw());
  send(ping);
}

bool LiveCamera::send(const KinectMessage& message) {
  return socket_.send(encode_kinect_binary(message));
}

std::int64_t LiveCamera::sender_ticks(HostTime t) const {
  // One second has 1e7 ticks.
  return static_cast<std::int64_t>(sender_.reading(seconds(t - start_)) * 1e7);
}

}  // namespace kinalign
