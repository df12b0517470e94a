// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/live/live_session.h"

#include "kinalign/models/live/live_joints.h"
#include "kinalign/models/skeleton_of_points.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

/// If a warning concerns more joints, it states their number in place of their names.
constexpr std::size_t most_named = 4;

/// Runs `denoise --live`. The Kinect's frames are brought to the model's frame rate, and each of
/// these frames is answered once the later frames that it needs have come. Invariant: made_ >=
/// answered_; the difference is at most the look-ahead.
class LiveDenoiseRun {
 public:
  LiveDenoiseRun(Denoiser& denoiser, const LiveJob& job, LiveSession& session)
      : model_(denoiser.model()),
        session_(session),
        stream_(live_kinect(job.kinect)),
        joints_(model_.layout.inputs, model_.layout.rate_hz),
        cleaner_(denoiser, job.look_ahead()),
        unseen_(model_.layout.inputs.size()) {}

  void begin() {
    // The first line of JSON has everything that a program must know before the frames come.
    session_.report("waiting for the Kinect's frames", Json{{"event", "started"},
                                                            {"method", model_.facts.method},
                                                            {"rate_hz", model_.layout.rate_hz},
                                                            {"look_ahead", cleaner_.look_ahead()}});
  }

  // Takes new data and answers the frames that are ready. Fails if two Kinects send and the user
  // chose none.
  Result<void> take(const LiveData& data) {
    for (const LiveKinectRow& row : data.rows) {
      // Rows of a second Kinect must not be mixed with those of the first one, so they are skipped
      // here.
      if (!KA_TRY(stream_.takes(row.kinect->stream))) continue;
      joints_.add(row.row, row.arrival);
      // Frames are made after each row, so that the latency of a frame counts from the arrival of
      // its last row.
      KA_TRY(advance(row.arrival));
    }
    // Frames may also become ready as time passes: after a while a silent Kinect is no longer
    // waited for.
    if (session_.stream().now()) KA_TRY(advance(*session_.stream().now()));
    return check_live_frames(answered_);
  }

  // The status for people: what the run waits for, or the number of frames and the latency.
  std::string status() const {
    // Before the Kinect's first row begin() is empty.
    if (!joints_.begin()) return "waiting for the Kinect's frames";
    return fmt::format("{} frames; {}", answered_, session_.latency_text());
  }

  // Answers the remaining frames after the end of the stream. They get no latency.
  Result<void> finish() {
    // The remaining frames wait for no arrival, so they have no latency.
    while (joints_.begin() && time_of(made_) <= *joints_.newest()) {
      KA_TRY(make_frame(std::nullopt));
    }
    while (const auto joints = cleaner_.finish()) KA_TRY(take_answer(*joints, std::nullopt));
    return {};
  }

  // The whole result, as a clip and as JSON. Frames after the Kinect's last row are left out, as in
  // a run on a file.
  Result<Json> answer(Clip& clip) const {
    if (answered_ == 0) return no_live_frames(status());
    const std::size_t frames = answered_ - std::min(answered_ - 1, behind_newest_);
    // whole() returns all answers before their bones were set to a fixed length. Here each bone
    // gets one length for the whole run.
    std::vector<float> whole = cleaner_.whole();
    whole.resize(whole.size() / answered_ * frames);
    clip = KA_TRY(skeleton(whole, *joints_.begin()));
    // In a run without joints the sum is 0; the maximum avoids a division by zero.
    const double all =
        static_cast<double>(std::max<std::size_t>(seen_[0] + seen_[1] + seen_[2], 1));
    Json missing = Json::object();
    for (std::size_t j = 0; j < unseen_.size(); ++j) {
      const double longest_s = static_cast<double>(unseen_[j].longest) / model_.layout.rate_hz;
      if (longest_s >= longest_unseen_s) missing[model_.layout.inputs[j]] = longest_s;
    }
    Json out{{"stream", stream_.name()},
             {"frames", frames},
             {"rate_hz", model_.layout.rate_hz},
             {"joints", model_.layout.outputs.size()},
             {"method", model_.facts.method},
             {"look_ahead", cleaner_.look_ahead()},
             {"missing", static_cast<double>(seen_[0]) / all},
             {"inferred", static_cast<double>(seen_[1]) / all},
             {"long_missing_s", missing},
             {"warnings", missing_warnings(missing)}};
    session_.describe(out);
    return out;
  }

 private:
  // The time of a frame. Frames have the model's rate and begin at the Kinect's first row.
  Time time_of(std::size_t frame) const {
    // The time is computed from the first frame, so that rounding errors do not add up.
    const double ns = static_cast<double>(frame) * 1e9 / model_.layout.rate_hz;
    return *joints_.begin() + Duration(std::llround(ns));
  }

  Result<Clip> skeleton(std::span<const float> positions, Time start) const {
    return skeleton_of_points({model_.layout.outputs, model_.layout.parents}, positions, start,
                              model_.layout.rate_hz);
  }

  // Makes every frame that is due and whose rows have come. `now`: the present time by the clock of
  // the stamps.
  Result<void> advance(Time now) {
    while (joints_.begin() && time_of(made_) <= now && joints_.is_ready(time_of(made_), now)) {
      KA_TRY(make_frame(now));
    }
    return {};
  }

  Result<void> make_frame(std::optional<Time> needed) {
    const JointFrames frame = joints_.frame(time_of(made_++));
    count(frame);
    // The cleaner answers the frame that is look_ahead() frames older than this one.
    if (const auto joints = cleaner_.step(frame)) return take_answer(*joints, needed);
    return {};
  }

  /// Counts missing joints. Frames after the Kinect's newest row are counted only once a further
  /// row has come, because a recorded file would end at the newest row.
  void count(const JointFrames& frame) {
    ++behind_newest_;
    // If a further row comes, this frame is counted then.
    if (time_of(made_ - 1) > *joints_.newest()) return;
    // Between two rows all joints were missing in the frames that are counted now.
    const std::size_t lost = behind_newest_ - 1;
    behind_newest_ = 0;
    for (std::size_t j = 0; j < unseen_.size(); ++j) {
      seen_[0] += lost;
      ++seen_[frame.seen[j]];
      unseen_[j].longest = std::max(unseen_[j].longest, unseen_[j].now + lost);
      unseen_[j].now = frame.seen[j] == 0 ? unseen_[j].now + lost + 1 : 0;
      unseen_[j].longest = std::max(unseen_[j].longest, unseen_[j].now);
    }
  }

  // Prints an answered frame. Before the first frame the skeleton is printed.
  Result<void> take_answer(const std::vector<float>& joints, std::optional<Time> needed) {
    // The bones of the skeleton have their lengths in this frame.
    const Clip one = KA_TRY(skeleton(joints, time_of(answered_)));
    if (answered_ == 0) {
      session_.report("", Json{{"event", "skeleton"},
                               {"joint_names", one.skeleton.joint_names},
                               {"parents", one.skeleton.parents}});
    }
    ++answered_;
    session_.report_frame(one.skeleton, one.frames, needed);
    return {};
  }

  struct Unseen {
    std::size_t now = 0, longest = 0;  // frames
  };
  const DenoiseModel& model_;
  LiveSession& session_;
  LiveChoice stream_;
  LiveJoints joints_;
  LiveCleaner cleaner_;
  // The number of frames given to the cleaner, and of those that it has answered.
  std::size_t made_ = 0, answered_ = 0;
  std::size_t behind_newest_ = 0;      // frames made after the Kinect's newest row
  std::array<std::size_t, 3> seen_{};  // number of joints in all frames, by Tracking
  std::vector<Unseen> unseen_;         // one element for each input joint
};

}  // namespace

std::vector<std::string> missing_warnings(const Json& long_missing) {
  std::map<std::string, std::vector<std::string>> joints;
  // Joints that were missing for the same time, such as a leg behind a table, get one line.
  for (const auto& [joint, seconds] : long_missing.items()) {
    joints[fmt::format("{:.1f}", seconds.get<double>())].push_back(harmless(joint));
  }
  std::vector<std::string> out;
  for (const auto& [seconds, names] : joints) {
    const std::string who = names.size() > most_named ? fmt::format("{} joints", names.size())
                                                      : fmt::format("{}", fmt::join(names, ", "));
    const bool is_one = names.size() == 1;
    out.push_back(fmt::format("{} {} missing for {} s: during this time {} a guess", who,
                              is_one ? "is" : "are", seconds, is_one ? "it is" : "they are"));
  }
  return out;
}

Result<Json> run_live_denoise(Denoiser& denoiser, const LiveJob& job, Clip& clip, Call& call) {
  return run_live<LiveDenoiseRun>(denoiser, job, clip, call);
}

}  // namespace kinalign
