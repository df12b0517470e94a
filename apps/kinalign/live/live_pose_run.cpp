// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/live/live_worn_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <utility>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

/// Runs `pose --live`: calibrates the nodes with a T-pose, then computes the pose of each frame.
/// LivePose does the computation; this class connects it with the stream, the reports and the final
/// clip.
class LivePoseRun {
 public:
  LivePoseRun(const PoseSolver& solver, const LiveJob& job, LiveSession& session)
      : model_(solver.model()),
        session_(session),
        pose_(solver, job.worn, job.look_ahead()),
        report_(model_.layout, job.nodes, pose_.worn(), session) {}

  void begin() {
    session_.report(LiveWornReport::instruction(),
                    Json{{"event", "started"},
                         {"method", model_.facts.method},
                         {"rate_hz", model_.layout.rate_hz},
                         {"look_ahead", pose_.look_ahead()},
                         {"joint_names", model_.body.skeleton.joint_names},
                         {"parents", model_.body.skeleton.parents}});
  }

  // Takes marks and samples, and answers the frames that are ready.
  Result<void> take(const LiveData& data) {
    // Marks come first, because a T-pose must be calibrated before the samples that follow it are
    // used.
    for (const LiveMark& mark : data.marks) report_.take(mark);
    for (const LiveNodeSample& sample : data.samples) {
      // add() returns true only for a node of the model. Only such a sample can complete a frame.
      if (KA_TRY(report_.add(sample))) advance(sample.arrival);
    }
    // Frames may also become ready as time passes: after a while a silent node is no longer waited
    // for.
    if (session_.stream().now()) advance(*session_.stream().now());
    return check_live_frames(frames_.size());
  }

  // The status for people: what the run waits for, or the number of frames, the latency and the
  // nodes.
  std::string status() const {
    std::string waits = report_.waits_for();
    if (!waits.empty()) return waits;
    return fmt::format("{} frames; {}; {}", frames_.size(), session_.latency_text(),
                       report_.names().text());
  }

  // Answers the remaining frames after the end of the stream. They get no latency.
  Result<void> finish() {
    std::vector<LivePoseFrame> answered;
    pose_.finish(answered);
    for (LivePoseFrame& frame : answered) take_answer(std::move(frame), std::nullopt);
    return {};
  }

  // The whole result, as a clip and as JSON. Frames after the last sample of the root's node were
  // answered, but are left out, as in a run on a file.
  Result<Json> answer(Clip& clip) {
    if (frames_.empty()) return no_live_frames(report_.waits_for());
    std::vector<Turn> rotations;
    std::vector<Eigen::Quaternionf> root;
    for (const LivePoseFrame& frame : frames_) {
      if (frame.stamp > *pose_.worn().nodes().newest_of_root())
        break;  // a run on a file ends here, too
      report_.count(frame.valid);
      rotations.insert(rotations.end(), frame.pose.rotations.begin(), frame.pose.rotations.end());
      root.push_back(frame.pose.root);
    }
    clip = {model_.body.skeleton, clip_frames(model_.body, rotations, root, model_.layout.rate_hz,
                                              frames_.front().stamp)};
    Json out{{"stream", report_.names().stream()}, {"frames", clip.frames.stamps.size()},
             {"rate_hz", model_.layout.rate_hz},   {"joints", model_.body.skeleton.joints()},
             {"method", model_.facts.method},      {"look_ahead", pose_.look_ahead()}};
    out.update(report_.about());
    session_.describe(out);
    return out;
  }

 private:
  /// Answers the frames that are ready. Frames that waited for the T-pose get no latency.
  void advance(Time now) {
    std::vector<LivePoseFrame> answered;
    pose_.advance(now, answered);
    // The frames of this call may have waited for the T-pose. The person and not the program caused
    // that delay.
    const bool waited = report_.report_t_pose();
    for (LivePoseFrame& frame : answered) {
      take_answer(std::move(frame), waited ? std::nullopt : std::optional(now));
    }
  }

  // Prints an answered frame and stores it for the file.
  void take_answer(LivePoseFrame frame, std::optional<Time> needed) {
    session_.report_frame(
        model_.body.skeleton,
        clip_frames(model_.body, frame.pose.rotations, std::span(&frame.pose.root, 1),
                    model_.layout.rate_hz, frame.stamp),
        needed);
    report_.watch(frame.valid);
    frames_.push_back(std::move(frame));
  }

  const PoseModel& model_;
  LiveSession& session_;
  LivePose pose_;
  LiveWornReport report_;
  std::vector<LivePoseFrame> frames_;
};

}  // namespace

Result<Json> run_live_pose(const PoseSolver& solver, const LiveJob& job, Clip& clip, Call& call) {
  return run_live<LivePoseRun>(solver, job, clip, call);
}

std::string live_lines(const Json& about) {
  const Json& latency = about.at("latency_ms");
  return fmt::format(
      "live     {:.0f} ms after the samples (p99 {:.0f}), {:.0f} ms behind the motion (p99 "
      "{:.0f})\n",
      latency.at("after_arrival_p50").get<double>(), latency.at("after_arrival_p99").get<double>(),
      latency.at("behind_motion_p50").get<double>(), latency.at("behind_motion_p99").get<double>());
}

}  // namespace kinalign
