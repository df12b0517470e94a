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

/// A warning that concerns more joints states their number instead of their names.
constexpr std::size_t most_named = 4;

/// Runs `denoise --live`: puts the Kinect's frames on the model's grid and answers each frame once
/// its later frames have come.
/// Invariant: made_ >= answered_. The difference is at most the look-ahead.
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
    // The first line of JSON has all that a program must know before the frames.
    session_.report("waiting for the Kinect's frames", Json{{"event", "started"},
                                                            {"method", model_.facts.method},
                                                            {"rate_hz", model_.layout.rate_hz},
                                                            {"look_ahead", cleaner_.look_ahead()}});
  }

  // Answers frames as soon as they are ready. Fails if two Kinects send and none was chosen.
  Result<void> take(const LiveData& data) {
    for (const LiveKinectRow& row : data.rows) {
      // The choice must come first: a second Kinect would be mixed into the first one's rows.
      if (!KA_TRY(stream_.takes(row.kinect->stream))) continue;
      joints_.add(row.row, row.arrival);
      // Frames are made after every row, so the arrival of this row is the one that they needed.
      KA_TRY(advance(row.arrival));
    }
    // A frame may also become ready because time passed: a Kinect that is silent is not waited for.
    if (session_.stream().now()) KA_TRY(advance(*session_.stream().now()));
    return check_live_frames(answered_);
  }

  // The status that a person reads: what is waited for, or frames and latency.
  std::string status() const {
    // begin() is absent before the first row.
    if (!joints_.begin()) return "waiting for the Kinect's frames";
    return fmt::format("{} frames; {}", answered_, session_.latency_text());
  }

  // Answers the rest of the frames after the stream's end, without latencies.
  Result<void> finish() {
    // The rest needs no arrival, so it has no latency.
    while (joints_.begin() && time_of(made_) <= *joints_.newest()) {
      KA_TRY(make_frame(std::nullopt));
    }
    while (const auto joints = cleaner_.finish()) KA_TRY(take_answer(*joints, std::nullopt));
    return {};
  }

  // The whole answer as a clip and as JSON. Frames after the Kinect's last row are left out, as for
  // a file.
  Result<Json> answer(Clip& clip) const {
    if (answered_ == 0) return no_live_frames(status());
    const std::size_t frames = answered_ - std::min(answered_ - 1, behind_newest_);
    // The cleaner keeps all answers until now, before bones get their length. Here they get one
    // length over the whole run.
    std::vector<float> whole = cleaner_.whole();
    whole.resize(whole.size() / answered_ * frames);
    clip = KA_TRY(skeleton(whole, *joints_.begin()));
    // The maximum keeps a run without joints from dividing by zero.
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
  // The stamp of a frame of the grid, which begins at the Kinect's first row.
  Time time_of(std::size_t frame) const {
    // The time is computed from the first frame, so rounding does not add up.
    const double ns = static_cast<double>(frame) * 1e9 / model_.layout.rate_hz;
    return *joints_.begin() + Duration(std::llround(ns));
  }

  Result<Clip> skeleton(std::span<const float> positions, Time start) const {
    return skeleton_of_points({model_.layout.outputs, model_.layout.parents}, positions, start,
                              model_.layout.rate_hz);
  }

  // Makes every frame that is due and whose row has come. `now`: on the axis of the stamps.
  Result<void> advance(Time now) {
    while (joints_.begin() && time_of(made_) <= now && joints_.is_ready(time_of(made_), now)) {
      KA_TRY(make_frame(now));
    }
    return {};
  }

  Result<void> make_frame(std::optional<Time> needed) {
    const JointFrames frame = joints_.frame(time_of(made_++));
    count(frame);
    // The cleaner answers the frame that lies look_ahead() frames back.
    if (const auto joints = cleaner_.step(frame)) return take_answer(*joints, needed);
    return {};
  }

  /// Counts missing joints. Frames after the Kinect's newest row count only once a further row has
  /// come: a file would end there.
  void count(const JointFrames& frame) {
    ++behind_newest_;
    // Such a frame may still turn out to be inside of the recording.
    if (time_of(made_ - 1) > *joints_.newest()) return;
    // The frames in between had no row of their own, so every joint was missing in them.
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

  // Prints an answered frame, and the skeleton before the first one.
  Result<void> take_answer(const std::vector<float>& joints, std::optional<Time> needed) {
    // The skeleton of one frame has the bone lengths of that moment.
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
  std::size_t made_ = 0, answered_ = 0;  // made_: frames given to the cleaner; answered_: frames it
                                         // answered
  std::size_t behind_newest_ = 0;        // frames made after the Kinect's newest row
  std::array<std::size_t, 3> seen_{};    // joints of all frames, by Tracking
  std::vector<Unseen> unseen_;           // [Jin] for each input joint
};

}  // namespace

std::vector<std::string> missing_warnings(const Json& long_missing) {
  std::map<std::string, std::vector<std::string>> joints;
  // Joints that vanish together, such as a whole leg behind a table, get one line.
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
