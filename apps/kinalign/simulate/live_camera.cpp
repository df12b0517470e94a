// SPDX-License-Identifier: Apache-2.0
// Stream 122 of the seed draws the delay of the sender's program: counter the frame's number, lane
// 0. A seed mixed with 122 draws the sender's clock.
#include "apps/kinalign/simulate/live_camera.h"

#include "apps/kinalign/simulate/live_suit.h"

#include "kinalign/protocols/kinect/binary.h"
#include "kinalign/protocols/kinect/stream.h"

#include <algorithm>
#include <array>

namespace kinalign {

namespace {

using namespace std::chrono_literals;

constexpr Duration hello_period = 1s, ping_period = 200ms;     // docs/formats/kinect_stream.md
constexpr std::uint64_t body_id = 72'057'594'037'927'936 + 1;  // above 2^53, as the SDK's ids

/// The body that the sensor saw; absent if no joint was found.
std::optional<KinectBody> body_of(const PointFrames& frames, std::size_t frame) {
  KinectBody body;
  body.id = body_id;
  bool seen = false;
  for (std::size_t j = 0; j < kinect_joint_count; ++j) {
    const std::size_t i = frame * kinect_joint_count + j;
    // `states` and `positions` are those of frame `frame` in arrays [T,J] and [T,J,3] m.
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

// Pongs are taken first: the stamp of their receipt must be as early as possible.
void LiveCamera::work() {
  receive();
  const HostTime now = clock_.raw();
  // Missed periods are caught up one by one, so the numbers of hellos and pings have no gap.
  for (; next_hello_ <= std::min(now, end_); next_hello_ += hello_period) send_hello();
  for (; next_ping_ <= std::min(now, end_); next_ping_ += ping_period) send_ping();
  for (HostTime due = frame_due(); due <= now; due = frame_due()) {
    // A late wake-up is a delay of this machine, which the summary reports.
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

/// The time at which the next frame is sent: its measurement and the delay of the program.
HostTime LiveCamera::frame_due() const {
  if (frame_ >= rehearsal_.ticks.size()) return HostTime::max();
  const double s = rehearsal_.ticks[frame_].seconds + program_delay_s(random_, frame_);
  return start_ + from_seconds(s);
}

/// Takes the pongs; the next ping echoes the latest one.
void LiveCamera::receive() {
  std::array<std::uint8_t, 64> room{};  // a pong has 36 bytes
  for (std::size_t size = socket_.receive(room); size > 0; size = socket_.receive(room)) {
    // One stamp for each pong, taken before it is decoded.
    const std::int64_t received = sender_ticks(clock_.raw());
    KinectMessage message;
    if (decode_kinect_datagram(std::span(room).first(size), message) != KinectRefusal::none)
      continue;
    const auto* pong = std::get_if<KinectPong>(&message);
    // A pong of another session belongs to an earlier run on the same port.
    if (pong == nullptr || pong->origin.session != session_) continue;
    echo_ = KinectEcho{pong->pong_sequence, pong->nonce, received};
  }
}

/// Sends the next frame; without a body if none was seen.
void LiveCamera::send_frame() {
  const KinectTick& tick = rehearsal_.ticks[frame_];
  KinectFrame frame;
  frame.origin = {1, session_, static_cast<std::uint32_t>(tick.number)};
  frame.device_ticks = tick.device;
  // Each frame is stamped twice: when it was due, and when it is sent.
  frame.taken_ticks = sender_ticks(frame_due());
  // The third clock of a frame is the wall clock, in microseconds.
  frame.utc_us = to_ns(clock_.utc()) / 1000;
  if (auto body = body_of(rehearsal_.kinect, frame_)) frame.bodies.push_back(*body);
  frame.sent_ticks = sender_ticks(clock_.raw());
  if (send(frame)) ++sent_;
  // The frame is over even if the system refused it: a camera does not repeat a frame.
  ++frame_;
}

void LiveCamera::send_hello() { send(KinectHello{origin(hellos_), "simulated", "kinalign"}); }

void LiveCamera::send_ping() {
  KinectPing ping{origin(pings_), 0, echo_};
  // The stamp is taken last, right before the datagram is sent.
  ping.sent_ticks = sender_ticks(clock_.raw());
  send(ping);
}

bool LiveCamera::send(const KinectMessage& message) {
  return socket_.send(encode_kinect_binary(message));
}

std::int64_t LiveCamera::sender_ticks(HostTime t) const {
  // 1e7 ticks are one second.
  return static_cast<std::int64_t>(sender_.reading(seconds(t - start_)) * 1e7);
}

}  // namespace kinalign
