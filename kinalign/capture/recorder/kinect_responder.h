// SPDX-License-Identifier: Apache-2.0
// The host's side of a Kinect sender's pings (docs/formats/kinect_stream.md). It decides which
// pings get a pong and computes the clock exchange of each ping. It uses no socket and no clock,
// and its memory is fixed. The caller passes the time.
#pragma once

#include "kinalign/capture/net/host_address.h"
#include "kinalign/capture/net/rate_limit.h"
#include "kinalign/capture/nodes/answer_pace.h"
#include "kinalign/capture/nodes/answer_table.h"
#include "kinalign/clock/host_from_node.h"
#include "kinalign/protocols/kinect/message.h"
#include "kinalign/wire/siphash.h"

#include <optional>
#include <vector>

namespace kinalign {

class KinectResponder {
 public:
  static constexpr std::size_t most_sessions = 32;

  /// `secret`: random in each run; used for nonces and for hashes of unknown senders.
  explicit KinectResponder(const SipHashKey& secret) : secret_(secret) {}

  /// Handles a ping. Call in the order of arrival. Absent: the ping is refused, because there are
  /// too many sessions or its address begins sessions too often.
  std::optional<Exchange> receive(const KinectPing& ping, const HostAddress& from, HostTime h_rx);
  /// Returns the pong for the previous ping, or nothing if no pong is to be sent. `h_tx` must be
  /// read just before this call, and the pong must be sent at once.
  std::optional<KinectPong> answer(HostTime h_tx);

 private:
  /// One run of one sensor's sender. An echo is valid only if it names a pong in `answers`, and
  /// only once. Replayed pings are therefore useless.
  struct Session {
    std::uint32_t sensor = 0, session = 0;
    HostTime last_ping{};
    AnswerTable answers;
    AnswerPace pace;
    std::uint32_t next_pong = 0;
  };
  Session* session_of(const KinectPing& ping, const HostAddress& from, HostTime now);
  static std::optional<HostTime> take_echo(Session& session, const KinectPing& ping);

  SipHashKey secret_;
  std::vector<Session> sessions_;
  RateLimit unknown_senders_;
  std::uint64_t nonces_ = 0;
  Session* asked_by_ = nullptr;  // session of the previous ping; nullptr: that ping gets no pong
  KinectOrigin asked_;
  HostTime asked_at_{};
};

}  // namespace kinalign
