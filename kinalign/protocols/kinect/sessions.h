// SPDX-License-Identifier: Apache-2.0
// Follows the sessions of one sensor's senders by their frames: which session is active, which have
// ended, and whether two senders send in turns. Two machines do so if their sensors have the same
// id. docs/formats/kinect_stream.md.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/protocols/kinect/message.h"

#include <array>
#include <cstdint>
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

/// Two senders with the same sensor id.
struct KinectTwins {
  std::uint32_t sensor = 0;
  std::array<std::string, 2> senders;  // their addresses; empty: unknown
  std::array<std::uint32_t, 2> sessions{};
};
/// The warning about two senders. `meaning`: what happens to their frames.
Finding two_senders(const std::string& place, const KinectTwins& twins, const std::string& meaning);

/// The sessions of one sensor: the newest one and the 16 before it.
class KinectSessions {
 public:
  enum class Turn {
    fresh,   // the first frame of an unknown session
    newest,  // a frame of the newest session
    beside,  // a frame of an older session that has advanced since: a late frame, or a second
             // sender
    over     // a frame of an older session, and nothing new
  };
  /// Takes the next frame; `sender` is its address.
  Turn hear(const KinectMoment& moment, std::string_view sender = {});

  /// The position of a session; nullptr if it is unknown.
  const KinectMoment* stand(std::uint32_t session) const;
  /// The position of the newest session; nullptr before the first frame.
  const KinectMoment* newest() const;
  /// True if the session's sender works at the same time as the newest session's: it advanced 16
  /// times, each time after a frame of another session. Chosen: no network delays frames in such a
  /// pattern.
  bool is_beside(std::uint32_t session) const;
  /// Number of such sessions.
  std::uint64_t beside() const { return beside_; }
  /// The first two senders found to work at the same time.
  const std::optional<KinectTwins>& twins() const { return twins_; }

 private:
  static constexpr std::size_t most = 17;
  static constexpr std::uint32_t enough_turns = 16;
  struct Session {
    KinectMoment stand;
    std::string sender;
    /// How often it advanced after a frame of another session, while it was not the newest.
    std::uint32_t turns = 0;
  };
  const Session* find(std::uint32_t session) const;
  const Session& current() const { return sessions_[(count_ - 1) % most]; }
  void go_on(Session& session, const KinectMoment& moment, std::string_view sender);

  std::array<Session, most> sessions_;
  std::uint64_t count_ = 0;       // all sessions so far
  std::uint32_t spoke_last_ = 0;  // session of the last frame that advanced
  std::uint64_t beside_ = 0;
  std::optional<KinectTwins> twins_;
};

}  // namespace kinalign
