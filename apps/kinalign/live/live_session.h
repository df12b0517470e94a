// SPDX-License-Identifier: Apache-2.0
// A verb that works live: it reads what record serves, hands it on, and tells what comes of it.
#pragma once

#include "apps/cli/console.h"
#include "apps/kinalign/live/live_latency.h"
#include "apps/kinalign/live/live_sockets.h"

#include "kinalign/capture/net/host_clock.h"
#include "kinalign/motion/clip.h"
#include "kinalign/recording/live/live_stream.h"

#include <nlohmann/json_fwd.hpp>

#include <functional>
#include <optional>
#include <string>

namespace kinalign {

/// Frames that are kept for a file at most: nine hours at 30 Hz.
inline constexpr std::size_t most_live_frames = 1'000'000;

/// Fails where a run has become too long.
Result<void> check_live_frames(std::size_t frames);
/// A run that answered nothing. `waited_for`: the status at its end.
Failure no_live_frames(const std::string& waited_for);
/// The stream of a Kinect; without a chosen one the first that sends. Fails where there are two.
Result<void> choose_live_kinect(const std::string& sends, bool is_chosen, std::string& stream);

/// What becomes of the stream.
struct LiveWork {
  /// A piece of the stream has come. Fails where nothing can be made of it.
  std::function<Result<void>(const LiveNews& news)> take;
  /// Twice a second, of a person's interest: "waiting for a T-pose".
  std::function<std::string()> status;
};

class LiveSession {
 public:
  /// Connects. `words`: checked.
  static Result<LiveSession> open(const LiveWords& words, Call& call);

  /// Until the stream ends, Ctrl-C, or a failure.
  Result<void> run(const LiveWork& work);

  const LiveStream& stream() const { return *stream_; }
  /// Now, on the axis of the stream's stamps. Of another machine's stream: when the newest message
  /// arrived there, and how long it has been here since.
  Time now();

  /// A frame of joints has its answer: on stdout with --json, and as a datagram with --send. `one`:
  /// one frame; `needed`: arrival of the newest message that it waited for; absent: it is of
  /// before the answers began, and its latency is none.
  void tell_frame(const Skeleton& skeleton, const ClipFrames& one, std::optional<Time> needed);
  /// A line for people and an object for programs.
  void tell(const std::string& line, const nlohmann::ordered_json& event);

  /// "9 ms after the samples (p99 21), 402 ms behind the motion (p99 440)", of the newest frames.
  std::string latency_text() const;
  /// Members that all verbs have at the end: latencies, messages lost, how the stream ended; and
  /// warnings of these, behind those that are there.
  void describe(nlohmann::ordered_json& about) const;

 private:
  LiveSession(LiveConnection connection, std::optional<LiveDatagrams> datagrams, Call& call);
  Result<bool> turn(const LiveWork& work);
  Result<void> tell_quiet(Duration silence);
  std::vector<std::string> warnings() const;

  LiveConnection connection_;
  std::optional<LiveDatagrams> datagrams_;
  Call* call_;
  std::unique_ptr<LiveStream> stream_;
  std::unique_ptr<SystemClocks> clocks_;
  std::optional<bool> is_own_host_;
  HostTime piece_came_;  // by our clock
  HostTime next_status_ = HostTime::min();
  LiveLatency latency_;
  bool is_quiet_ = false;
  bool broke_ = false;
};

}  // namespace kinalign
