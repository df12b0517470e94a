// SPDX-License-Identifier: Apache-2.0
// Runs a model that fuses a Kinect and nodes on live frames. Each pose is returned after a fixed
// delay, and the network runs over a window of the newest frames. Node headings are estimated from
// earlier frames only. A returned frame keeps the headings that it was computed with; later frames
// in the window get the newest headings.
#pragma once

#include "kinalign/infer/window_network.h"
#include "kinalign/models/fuse/fuse_model.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace kinalign {

/// The pose of one frame in the Kinect's world.
struct FusedFramePose {
  std::vector<Turn> rotations;  // [B] relative to the root
  Eigen::Quaternionf root = Eigen::Quaternionf::Identity();
  Eigen::Vector3f place = Eigen::Vector3f::Zero();  // m
};

/// add() takes frames in order and answer() gives the poses; until is_turned() frames only wait.
/// `window_`, `kinect_`, `both_` and `headings_` always begin with the same frame.
class LiveFuser {
 public:
  /// At most this many frames are kept while the rotation between the two devices' worlds is
  /// unknown.
  static constexpr std::size_t most_waiting = 1800;

  /// `fuser` must outlive this object and must not be moved. `look_ahead`: see LiveCleaner.
  LiveFuser(Fuser& fuser, std::size_t look_ahead);

  std::size_t look_ahead() const { return ahead_; }
  /// True once the rotation between the devices' worlds is known. This needs one second in which
  /// both devices see the person. Before that no pose is returned.
  bool is_turned() const { return yaw_.has_value(); }
  /// Call when the nodes have a new calibration: from the next frame on, their headings are
  /// estimated without earlier frames.
  void begin_headings();

  /// Takes the next frame; `input` contains only this frame.
  void add(const FuseInput& input);
  /// Appends all poses that can be computed now, up to the frame look_ahead() frames before the
  /// newest. The network runs once for all of them, so a program that was too slow catches up. Its
  /// frames then use more later frames.
  void answer(std::vector<FusedFramePose>& out);
  /// Call when no further frames come: appends the remaining poses.
  void finish(std::vector<FusedFramePose>& out);
  /// Frames in the window that wait for later frames. Frames received before is_turned() are not
  /// counted.
  std::size_t unanswered() const { return window_.frames() - next_; }
  /// Frames dropped because both devices were not seen together in time.
  std::size_t forgotten() const { return forgotten_; }

  /// The Kinect's estimate of each node's heading [N], at the newest answer.
  const std::vector<HeadingState>& headings() const { return states_; }

 private:
  /// The features of the window, for the Kinect alone or for both devices.
  struct Seen {
    FuseFeatureMaker maker;
    WindowNetwork network;
    std::vector<float> rows{};        // [window, channels] the standardised channels
    std::vector<FuseSpace> spaces{};  // one space for each frame of the window

    void make(const FuseModel& model, const FuseInput& input, std::size_t row);
    void forget_first();
  };

  void take(FuseInput input);
  void find_headings(std::size_t end);
  std::span<const float> answers_to_both(const FuseInput& corrected, std::size_t answered,
                                         std::size_t end);
  void answer_rows(std::size_t count, std::vector<FusedFramePose>& out);

  Fuser* fuser_;
  // number of later and of earlier frames in the window, seen from the answered frame
  std::size_t ahead_, behind_;
  std::optional<double> yaw_;  // rad, rotates the nodes' world to the Kinect's
  FuseInput waiting_;          // frames received before the yaw is known
  FuseInput window_;
  Seen kinect_, both_;                  // the state of both_.maker is that of row next_
  std::vector<HeadingState> headings_;  // [window,N] of each node in each frame
  std::size_t next_ = 0;                // the row of the window that is answered next
  std::size_t forgotten_ = 0;
  HeadingFilter filter_;
  std::vector<HeadingState> states_;
};

}  // namespace kinalign
