// SPDX-License-Identifier: Apache-2.0
// The connection of a live verb to `record`: reads the stream, passes its data to the verb, and
// reports the verb's answers.
#pragma once

#include "apps/cli/console.h"
#include "apps/kinalign/live/live_latency.h"
#include "apps/kinalign/live/live_node_names.h"
#include "apps/kinalign/live/live_runs.h"
#include "apps/kinalign/live/live_sockets.h"

#include "kinalign/capture/net/host_clock.h"
#include "kinalign/motion/clip.h"
#include "kinalign/recording/live/live_stream.h"

#include <nlohmann/json_fwd.hpp>

#include <functional>
#include <optional>
#include <string>
#include <utility>

namespace kinalign {

/// The largest number of frames that are stored for a file: nine hours at 30 Hz.
inline constexpr std::size_t most_live_frames = 1'000'000;

/// Fails if a run has reached the largest number of frames. A clip is written at the end, so all
/// frames stay in memory until then.
Result<void> check_live_frames(std::size_t frames);
/// The error of a run in which no frame was answered. `waited_for`: the status at the end of the
/// run.
Failure no_live_frames(const std::string& waited_for);
/// The choice of the Kinect in a run. `name`: the name of its stream; empty: the first that sends.
inline LiveChoice live_kinect(const std::string& name) {
  return {name, "one Kinect (its stream by name)"};
}

/// The functions of a verb that the session calls.
struct LiveWork {
  /// Called for each piece of the stream. Fails if the piece can't be used.
  std::function<Result<void>(const LiveData& data)> take;
  /// Returns the status for people, such as "waiting for a T-pose". Called twice a second.
  std::function<std::string()> status;
};

/// Connects a verb with the stream of `record`. One thread reads the stream, answers the frames
/// that are ready, and prints them.
class LiveSession {
 public:
  /// Connects to `record`. check() must have accepted `words`.
  static Result<LiveSession> open(const LiveWords& words, Call& call);

  /// Runs until the stream ends, the user presses Ctrl-C, or a callback fails.
  Result<void> run(const LiveWork& work);

  const LiveStream& stream() const { return *stream_; }
  /// The present time by the clock of the stream's stamps. If the stream comes from another
  /// machine: the arrival of its newest message there, plus the time since that message came here.
  Time now();

  /// Reports an answered frame: on stdout with --json, as a datagram with --send. `one`: a clip of
  /// this frame only. `needed`: the arrival of the newest message that the answer needed; empty:
  /// the frame gets no latency.
  void report_frame(const Skeleton& skeleton, const ClipFrames& one, std::optional<Time> needed);
  /// Prints a line for people and a JSON object for programs.
  void report(const std::string& line, const nlohmann::ordered_json& event);

  /// The latencies of the newest frames in words: "9 ms after the samples (p99 21), 402 ms behind
  /// the motion (p99 440)".
  std::string latency_text() const;
  /// Adds the JSON members that all live verbs share: latencies, lost messages, and how the stream
  /// ended. Also appends the warnings about them.
  void describe(nlohmann::ordered_json& about) const;

 private:
  LiveSession(LiveConnection connection, std::optional<LiveDatagrams> datagrams, Call& call);
  Result<bool> turn(const LiveWork& work);
  Result<void> report_quiet(Duration silence);
  std::vector<std::string> warnings() const;

  LiveConnection connection_;
  std::optional<LiveDatagrams> datagrams_;
  Call* call_;
  // The stream is behind a pointer, because the session is moved and a stream can't be.
  std::unique_ptr<LiveStream> stream_;
  std::unique_ptr<SystemClocks> clocks_;
  std::optional<bool> is_own_host_;  // `record` runs on this machine; empty: not known yet
  HostTime piece_came_;              // arrival of the last piece, by this machine's clock
  HostTime next_status_ = HostTime::min();
  LiveLatency latency_;
  bool is_quiet_ = false;  // true: the silence was reported
  bool broke_ = false;     // true: the connection ended before the stream did
};

/// Makes a live run from the connection to the last frame and returns the JSON about it. `Run` is a
/// class with begin(), take(), status(), finish() and answer().
template <class Run>
auto run_live(auto& model, const LiveJob& job, Clip& clip, Call& call)
    -> decltype(std::declval<Run&>().answer(clip)) {
  LiveSession session = KA_TRY(LiveSession::open(job.words, call));
  Run run(model, job, session);
  run.begin();
  // Both functions refer to `run`, which lives longer than the session's loop.
  KA_TRY(session.run(
      {[&](const LiveData& data) { return run.take(data); }, [&] { return run.status(); }}));
  KA_TRY(run.finish());
  return run.answer(clip);
}

}  // namespace kinalign
