// SPDX-License-Identifier: Apache-2.0
// The session of a verb that works live: reads the stream of record, hands it on, and reports
// answers.
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

/// The most frames that are kept for a file: nine hours at 30 Hz.
inline constexpr std::size_t most_live_frames = 1'000'000;

/// Fails if a run has reached the most frames.
/// A clip is written only at the end, so all frames stay in memory until then.
Result<void> check_live_frames(std::size_t frames);
/// The failure of a run without an answered frame. `waited_for`: the status at its end.
Failure no_live_frames(const std::string& waited_for);
/// The Kinect of a run. `name`: of its stream; empty: the first that sends.
inline LiveChoice live_kinect(const std::string& name) {
  return {name, "one Kinect (its stream by name)"};
}

/// The callbacks for the stream.
struct LiveWork {
  /// Called for each piece of the stream. Fails if the piece can't be used.
  std::function<Result<void>(const LiveData& data)> take;
  /// The status for a person, asked twice a second: "waiting for a T-pose".
  std::function<std::string()> status;
};

/// One thread does everything: it reads a piece, answers the frames that it completes, and prints
/// them.
class LiveSession {
 public:
  /// Connects. `words`: after check().
  static Result<LiveSession> open(const LiveWords& words, Call& call);

  /// Runs until the stream ends, Ctrl-C is pressed, or a callback fails.
  Result<void> run(const LiveWork& work);

  const LiveStream& stream() const { return *stream_; }
  /// The present time on the axis of the stream's stamps. For a stream of another machine: the
  /// arrival of the newest message there, plus the time since it came here.
  Time now();

  /// Reports an answered frame: on stdout with --json, as a datagram with --send. `one`: a single
  /// frame. `needed`: the arrival of the newest message that the answer needed; absent: the frame
  /// is older than the first answer and gets no latency.
  void report_frame(const Skeleton& skeleton, const ClipFrames& one, std::optional<Time> needed);
  /// Prints a line for people and an object for programs.
  void report(const std::string& line, const nlohmann::ordered_json& event);

  /// The latencies of the newest frames: "9 ms after the samples (p99 21), 402 ms behind the motion
  /// (p99 440)".
  std::string latency_text() const;
  /// Adds the members that all verbs have at the end: latencies, lost messages, the way the stream
  /// ended. Appends warnings about these.
  void describe(nlohmann::ordered_json& about) const;

 private:
  LiveSession(LiveConnection connection, std::optional<LiveDatagrams> datagrams, Call& call);
  Result<bool> turn(const LiveWork& work);
  Result<void> report_quiet(Duration silence);
  std::vector<std::string> warnings() const;

  LiveConnection connection_;
  std::optional<LiveDatagrams> datagrams_;
  Call* call_;
  // A pointer, because the session is moved once and a stream can't be.
  std::unique_ptr<LiveStream> stream_;
  std::unique_ptr<SystemClocks> clocks_;
  std::optional<bool> is_own_host_;  // record runs on this machine; absent: not known yet
  HostTime piece_came_;              // by this machine's clock
  HostTime next_status_ = HostTime::min();
  LiveLatency latency_;
  bool is_quiet_ = false;  // the pause was reported
  bool broke_ = false;     // the stream ended without record's end
};

/// Runs `run` from the connection to the last frame and returns the JSON about it. `Run` has
/// begin(), take(), status(), finish() and answer().
template <class Run>
auto run_live(auto& model, const LiveJob& job, Clip& clip, Call& call)
    -> decltype(std::declval<Run&>().answer(clip)) {
  LiveSession session = KA_TRY(LiveSession::open(job.words, call));
  Run run(model, job, session);
  run.begin();
  // The functions refer to `run`, which outlives the session's loop.
  KA_TRY(session.run(
      {[&](const LiveData& data) { return run.take(data); }, [&] { return run.status(); }}));
  KA_TRY(run.finish());
  return run.answer(clip);
}

}  // namespace kinalign
