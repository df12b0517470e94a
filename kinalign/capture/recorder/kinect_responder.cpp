// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/recorder/kinect_responder.h"

#include "kinalign/protocols/kinect/frames.h"

#include <algorithm>
#include <cstring>

namespace kinalign {

namespace {

// If the table is full, a new session replaces the session that was silent longest. That session
// must have been silent for at least this time.
constexpr Duration replaced_after = std::chrono::minutes(1);

}  // namespace

std::optional<Exchange> KinectResponder::receive(const KinectPing& ping, const HostAddress& from,
                                                 HostTime h_rx) {
  asked_by_ = nullptr;
  Session* session = session_of(ping, from, h_rx);
  if (session == nullptr) return std::nullopt;
  session->last_ping = h_rx;
  // A ping that exceeds the pace is still a valid exchange, but gets no pong.
  if (session->pace.ask(h_rx)) asked_by_ = session;
  asked_ = ping.origin;
  asked_at_ = h_rx;
  return exchange_of(ping, h_rx, take_echo(*session, ping));
}

/// Finds or begins the session of a ping. Returns nullptr if the ping is refused.
KinectResponder::Session* KinectResponder::session_of(const KinectPing& ping,
                                                      const HostAddress& from, HostTime now) {
  auto place = std::find_if(sessions_.begin(), sessions_.end(), [&](const Session& one) {
    return one.sensor == ping.origin.sensor && one.session == ping.origin.session;
  });
  if (place == sessions_.end()) {
    const std::uint64_t hash = siphash_2_4(secret_, address_prefix(from));
    if (unknown_senders_.ask(hash, now) != RateLimit::Verdict::answer) return nullptr;
    if (sessions_.size() < most_sessions) {
      place = sessions_.emplace(sessions_.end());
    } else {
      place =
          std::min_element(sessions_.begin(), sessions_.end(),
                           [](const auto& a, const auto& b) { return a.last_ping < b.last_ping; });
      if (now - place->last_ping <= replaced_after) return nullptr;
      *place = {};
    }
    place->sensor = ping.origin.sensor;
    place->session = ping.origin.session;
  }
  return &*place;
}

/// Returns the time when the echoed pong was sent. Absent if the ping has no valid echo.
std::optional<HostTime> KinectResponder::take_echo(Session& session, const KinectPing& ping) {
  if (!ping.echo || ping.echo->received_ticks > ping.sent_ticks) return std::nullopt;
  GivenAnswer answer;
  const auto found = session.answers.find(ping.echo->pong_sequence, ping.echo->nonce, answer);
  return found == EchoVerdict::taken ? std::optional(answer.t3) : std::nullopt;
}

// Every pong is stored, because an echo is checked against the stored pongs.
std::optional<KinectPong> KinectResponder::answer(HostTime h_tx) {
  Session* session = std::exchange(asked_by_, nullptr);
  if (session == nullptr) return std::nullopt;
  std::array<std::uint8_t, sizeof nonces_> number{};
  std::memcpy(number.data(), &++nonces_, number.size());
  // The nonce is a counter hashed with the secret, so it can't be guessed.
  const auto nonce = static_cast<std::uint32_t>(siphash_2_4(secret_, number));
  const std::uint32_t sequence = session->next_pong++;
  session->answers.add({sequence, nonce, asked_at_, h_tx});
  return KinectPong{asked_, sequence, nonce};
}

}  // namespace kinalign
