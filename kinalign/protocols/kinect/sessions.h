// SPDX-License-Identifier: Apache-2.0
// The runs of one sensor's senders, as its frames tell them: which one speaks, which are over, and
// whether two speak by turns, as two machines do whose sensors were given the same id.
// docs/formats/kinect_stream.md.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/protocols/kinect/message.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kinalign {

/// Where a session stands.
struct KinectMoment {
  KinectOrigin origin;
  std::int64_t device_ticks = 0, sent_ticks = 0;
};
KinectMoment moment_of(const KinectFrame& frame);
/// By the sensor's clock, or by the sender's where that one has begun anew.
bool has_newer_ticks(const KinectMoment& one, const KinectMoment& than);

/// Two senders of one sensor's id.
struct KinectTwins {
  std::uint32_t sensor = 0;
  std::array<std::string, 2> senders;  // where they sent from; empty: not known
  std::array<std::uint32_t, 2> sessions{};
};
/// `meaning`: what becomes of their frames.
Finding two_senders(const std::string& place, const KinectTwins& twins, const std::string& meaning);

/// One sensor's: the newest session and the 16 before it.
class KinectSessions {
 public:
  enum class Turn {
    fresh,   // the first frame of a session that was not known
    newest,  // of the newest session
    beside,  // of one before it that has gone on since: a straggler, or a second sender
    over     // of one before it, and nothing new
  };
  Turn hear(const KinectMoment& moment, std::string_view sender = {});

  /// Where that session stands; nullptr: it isn't known.
  const KinectMoment* stand(std::uint32_t session) const;
  /// Of the newest session; nullptr before the first frame.
  const KinectMoment* newest() const;
  /// Its sender is at work beside the newest session's: it went on 16 times, each time behind a
  /// frame of another session. Chosen: no network holds frames back in such pieces.
  bool is_beside(std::uint32_t session) const;
  /// How many have been so.
  std::uint64_t beside() const { return beside_; }
  /// The first two.
  const std::optional<KinectTwins>& twins() const { return twins_; }

 private:
  static constexpr std::size_t most = 17;
  static constexpr std::uint32_t enough_turns = 16;
  struct Session {
    KinectMoment stand;
    std::string sender;
    std::uint32_t turns = 0;  // in which it went on though it was not the newest
  };
  const Session* find(std::uint32_t session) const;
  const Session& current() const { return sessions_[(count_ - 1) % most]; }
  void go_on(Session& session, const KinectMoment& moment, std::string_view sender);

  std::array<Session, most> sessions_;
  std::uint64_t count_ = 0;       // of all that were
  std::uint32_t spoke_last_ = 0;  // the session
  std::uint64_t beside_ = 0;
  std::optional<KinectTwins> twins_;
};

}  // namespace kinalign
