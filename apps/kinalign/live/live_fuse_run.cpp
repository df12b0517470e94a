// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/live/live_worn_report.h"

#include "kinalign/models/live/live_joints.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <deque>
#include <numbers>
#include <utility>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

/// Runs `fuse --live`: calibrates the nodes with a T-pose, then passes frames of the nodes and the
/// Kinect to the fuser. A frame is first made (worn_), then given to the fuser (pending_), then
/// answered (poses_ and answered_). Invariant: pending_ has exactly the frames that the fuser has
/// not answered.
class LiveFuseRun {
 public:
  LiveFuseRun(Fuser& fuser, const LiveJob& job, LiveSession& session)
      : model_(fuser.model()),
        nodes_(model_.layout.nodes),
        session_(session),
        stream_(live_kinect(job.kinect)),
        worn_(nodes_, model_.body.skeleton, job.worn),
        report_(nodes_, job.nodes, worn_, session),
        joints_(model_.layout.joints, nodes_.rate_hz),
        fuser_(fuser, job.look_ahead()) {}

  void begin() {
    session_.report(LiveWornReport::instruction() + ", before the Kinect",
                    Json{{"event", "started"},
                         {"method", model_.facts.method},
                         {"rate_hz", nodes_.rate_hz},
                         {"look_ahead", fuser_.look_ahead()},
                         {"joint_names", model_.body.skeleton.joint_names},
                         {"parents", model_.body.skeleton.parents}});
  }

  // Takes marks, rows of the Kinect and samples of nodes, and answers the frames that are ready.
  Result<void> take(const LiveData& data) {
    // Marks come first, because a T-pose is calibrated with samples that have already come.
    for (const LiveMark& mark : data.marks) report_.take(mark);
    for (const LiveKinectRow& row : data.rows) {
      if (KA_TRY(stream_.takes(row.kinect->stream))) joints_.add(row.row, row.arrival);
    }
    for (const LiveNodeSample& sample : data.samples) KA_TRY(report_.add(sample));
    // All samples of this call are stored before, so that the network runs once for all frames that
    // are ready.
    if (session_.stream().now()) advance(*session_.stream().now());
    return check_live_frames(poses_.size());
  }

  // The status for people: what the run waits for, or the number of frames, the latency and the
  // nodes.
  std::string status() const {
    std::string waits = report_.waits_for();
    if (!waits.empty()) return waits;
    if (!joints_.begin()) return "waiting for the Kinect's frames";
    if (poses_.empty()) return "waiting for a second in which the Kinect sees the person";
    return fmt::format("{} frames; {}; {}", poses_.size(), session_.latency_text(),
                       report_.names().text());
  }

  // Answers the remaining frames after the end of the stream. They get no latency.
  Result<void> finish() {
    std::vector<LiveWornFrame> ready;
    std::vector<FusedFramePose> answered;
    // The last frames are made first; then the fuser is finished and answers all of them.
    worn_.finish(ready);
    for (const LiveWornFrame& frame : ready) take_frame(frame);
    fuser_.finish(answered);
    for (FusedFramePose& pose : answered) take_answer(std::move(pose), std::nullopt);
    return {};
  }

  // The whole result, as a clip and as JSON. Frames after the last sample of the root's node are
  // left out, as in a run on a file.
  Result<Json> answer(Clip& clip) {
    if (poses_.empty()) return no_live_frames(status());
    std::vector<Turn> rotations;
    std::vector<Eigen::Quaternionf> root;
    for (std::size_t t = 0; t < poses_.size(); ++t) {
      if (answered_[t].stamp > *worn_.nodes().newest_of_root())
        break;  // a run on a file ends here, too
      report_.count(answered_[t].valid);
      rotations.insert(rotations.end(), poses_[t].rotations.begin(), poses_[t].rotations.end());
      root.push_back(poses_[t].root);
    }
    clip = {model_.body.skeleton,
            // All frames have the same body, so the clip has one skeleton.
            clip_frames(model_.body, rotations, root, nodes_.rate_hz, answered_.front().stamp)};
    for (std::size_t t = 0; t < root.size(); ++t) put_place(poses_[t], t, clip.frames);
    return about(root.size());
  }

 private:
  // Writes the root's position into frame t. The root is joint 0.
  void put_place(const FusedFramePose& pose, std::size_t t, ClipFrames& frames) const {
    vec3(frames.local_positions, t * model_.body.skeleton.joints()) = pose.place.cast<double>();
  }

  /// Answers the frames that are ready. Frames that waited for the T-pose or for the Kinect get no
  /// latency.
  void advance(Time now) {
    std::vector<LiveWornFrame> ready;
    std::vector<FusedFramePose> answered;
    // A frame is ready if it no longer waits for samples of the nodes or for a row of the Kinect.
    worn_.advance(
        now, [&](Time time) { return joints_.is_ready(time, now); }, ready);
    bool waited = report_.report_t_pose();
    // A new calibration changes the orientation of each node on its bone. Headings that were found
    // before are then wrong.
    if (waited) fuser_.begin_headings();
    // The fuser answers frames only once it knows the rotation between the Kinect's coordinates and
    // those of the nodes. Frames that waited for it are answered in this call, so the state before
    // the call is needed.
    const bool was_turned = fuser_.is_turned();
    for (const LiveWornFrame& frame : ready) take_frame(frame);
    fuser_.answer(answered);
    waited = waited || !was_turned;
    for (FusedFramePose& pose : answered) {
      take_answer(std::move(pose), waited ? std::nullopt : std::optional(now));
    }
  }

  // Gives a frame to the fuser. If the fuser drops old frames before its first answer, they are
  // dropped here, too.
  void take_frame(const LiveWornFrame& frame) {
    FuseInput input{frame.nodes, joints_.frame(frame.stamp)};
    for (const std::uint8_t seen : input.kinect.seen) ++seen_[seen];
    pending_.push_back({frame.stamp, frame.nodes.valid});
    // The fuser drops its oldest waiting frame if nodes and Kinect are not seen together for too
    // long.
    const std::size_t forgotten = fuser_.forgotten();
    fuser_.add(input);
    if (fuser_.forgotten() == forgotten) return;
    // pending_ begins with the frames in the fuser's window. The dropped frame follows them.
    pending_.erase(pending_.begin() + static_cast<std::ptrdiff_t>(fuser_.unanswered()));
  }

  // Prints an answered frame and stores it for the file.
  void take_answer(FusedFramePose pose, std::optional<Time> needed) {
    // The fuser answers frames in their order, so the answer is for the first pending frame.
    Pending pending = std::move(pending_.front());
    pending_.pop_front();
    ClipFrames one = clip_frames(model_.body, pose.rotations, std::span(&pose.root, 1),
                                 nodes_.rate_hz, pending.stamp);
    put_place(pose, 0, one);
    session_.report_frame(model_.body.skeleton, one, needed);
    report_.watch(pending.valid);
    answered_.push_back(std::move(pending));
    poses_.push_back(std::move(pose));
  }

  Json about(std::size_t frames) const {
    const double all =
        static_cast<double>(std::max<std::size_t>(seen_[0] + seen_[1] + seen_[2], 1));
    Json out{{"kinect", stream_.name()},
             {"imu", report_.names().stream()},
             {"frames", frames},
             {"rate_hz", nodes_.rate_hz},
             {"joints", model_.body.skeleton.joints()},
             {"method", model_.facts.method},
             {"look_ahead", fuser_.look_ahead()},
             {"missing", static_cast<double>(seen_[0]) / all},
             {"inferred", static_cast<double>(seen_[1]) / all}};
    out.update(report_.about());
    // The JSON has the corrections of the headings at the newest answer.
    out["found_headings"] = headings_json(nodes_.nodes, fuser_.headings());
    session_.describe(out);
    return out;
  }

  struct Pending {
    Time stamp{};
    std::vector<std::uint8_t> valid;
  };
  const FuseModel& model_;
  const PoseLayout& nodes_;
  LiveSession& session_;
  LiveChoice stream_;  // the choice of the Kinect's stream
  LiveWorn worn_;
  LiveWornReport report_;
  LiveJoints joints_;
  LiveFuser fuser_;
  std::deque<Pending> pending_;  // the frames that the fuser has not answered yet
  std::vector<Pending> answered_;
  std::vector<FusedFramePose> poses_;
  std::array<std::size_t, 3> seen_{};  // number of joints in all frames, by Tracking
};

}  // namespace

Json headings_json(const std::vector<std::string>& nodes, std::span<const HeadingState> states) {
  Json out = Json::object();
  const double degrees = 180.0 / std::numbers::pi;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    out[nodes[n]] = {{"turned_deg", degrees * static_cast<double>(states[n].yaw)},
                     {"spread_deg", degrees * static_cast<double>(states[n].spread)}};
  }
  return out;
}

Result<Json> run_live_fuse(Fuser& fuser, const LiveJob& job, Clip& clip, Call& call) {
  return run_live<LiveFuseRun>(fuser, job, clip, call);
}

}  // namespace kinalign
