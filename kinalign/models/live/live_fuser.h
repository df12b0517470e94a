// SPDX-License-Identifier: Apache-2.0
// A model that fuses a Kinect and nodes frame by frame, some frames late: it runs over a window of
// the newest frames. The headings of the nodes are found by earlier frames alone: those of a frame
// that is answered stay as they were then, and later ones have the newest.
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
  std::vector<Turn> rotations;  // [B] against the root
  Eigen::Quaternionf root = Eigen::Quaternionf::Identity();
  Eigen::Vector3f place = Eigen::Vector3f::Zero();  // m
};

class LiveFuser {
 public:
  /// Frames before both devices show how their worlds are turned are kept so long.
  static constexpr std::size_t most_waiting = 1800;

  /// `fuser` must live longer and must not be moved. `look_ahead`: as LiveCleaner has it.
  LiveFuser(Fuser& fuser, std::size_t look_ahead);

  std::size_t look_ahead() const { return ahead_; }
  /// Both devices were seen together for a second: only then frames are answered.
  bool is_turned() const { return yaw_.has_value(); }
  /// The nodes have another calibration from the next frame on: their heading is looked for anew.
  void begin_headings();

  /// Takes the next frame; `input` holds it alone.
  void add(const FuseInput& input);
  /// Appends the poses that can be answered now; the newest is of the frame look_ahead() before the
  /// newest one. The network runs once for all of them, however many are due: a program that has
  /// fallen behind catches up, and its frames see more later ones.
  void answer(std::vector<FusedFramePose>& out);
  /// No further frames come: the poses that are left.
  void finish(std::vector<FusedFramePose>& out);
  /// Frames that have come and wait for later ones, beside those that wait for a second in which
  /// both devices are seen.
  std::size_t unanswered() const { return window_.frames() - next_; }
  /// Frames that were forgotten before both devices were seen.
  std::size_t forgotten() const { return forgotten_; }

  /// What the Kinect says of each node's heading [N], at the newest answer.
  const std::vector<HeadingState>& headings() const { return states_; }

 private:
  /// The window as the network sees it: the Kinect alone, or both devices.
  struct Seen {
    FuseFeatureMaker maker;
    WindowNetwork network;
    std::vector<float> rows{};        // [window, channels] standardised
    std::vector<FuseSpace> spaces{};  // [window]

    void make(const FuseModel& model, const FuseInput& input, std::size_t row);
    void forget_first();
  };

  void take(FuseInput input);
  void find_headings(std::size_t end);
  std::span<const float> answers_to_both(const FuseInput& corrected, std::size_t answered,
                                         std::size_t end);
  void answer_rows(std::size_t count, std::vector<FusedFramePose>& out);

  Fuser* fuser_;
  std::size_t ahead_, behind_;
  std::optional<double> yaw_;  // that brings the nodes' world to the Kinect's
  FuseInput waiting_;          // frames that no yaw is known for
  FuseInput window_;
  Seen kinect_, both_;          // of both_ the maker stands at the row that is answered next
  std::size_t kinect_run_ = 0;  // rows that the network has seen of the Kinect alone
  std::vector<HeadingState> headings_;  // [window,N]
  std::size_t next_ = 0;                // row of the window that is answered next
  std::size_t forgotten_ = 0;
  HeadingFilter filter_;
  std::vector<HeadingState> states_;
};

}  // namespace kinalign
