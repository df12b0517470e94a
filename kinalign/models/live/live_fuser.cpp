// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/live/live_fuser.h"

#include "kinalign/infer/shapes.h"
#include "kinalign/motion/frame_arrays.h"

#include <algorithm>
#include <utility>

namespace kinalign {

namespace {

/// Frames kept if the network uses the whole sequence.
constexpr std::size_t remembered_by_network = 60;
/// Frames on each side used by Smoothing{} for the root's position.
constexpr std::size_t smoothed_places = 4;
/// Earlier rows that the smoothing needs, of positions at the window's end and of the Kinect's
/// joints.
constexpr std::size_t smoothed_rows = 9;

void append_input(FuseInput& all, const FuseInput& more) {
  append_frames(all.nodes, more.nodes);
  all.kinect.joints = more.kinect.joints;
  append_to(all.kinect.positions, more.kinect.positions);
  append_to(all.kinect.seen, more.kinect.seen);
}

// Copies one frame, so that the functions for whole sequences also serve single frames.
FuseInput frame_at(const FuseInput& all, std::size_t t) {
  const std::size_t joints = all.kinect.joints;
  return {
      frame_at(all.nodes, t),
      {joints, row_of(all.kinect.positions, t, 3 * joints), row_of(all.kinect.seen, t, joints)}};
}

void forget_first(FuseInput& all) {
  erase_first_frames(all.nodes, 1);
  erase_first(all.kinect.positions, 3 * all.kinect.joints);
  erase_first(all.kinect.seen, all.kinect.joints);
}

}  // namespace

/// Appends the network's channels for row `row` of `input`.
void LiveFuser::Seen::make(const FuseModel& model, const FuseInput& input, std::size_t row) {
  const std::size_t channels = model.layout.channels(), begin = rows.size();
  rows.resize(begin + channels);
  const std::span<float> out = std::span(rows).subspan(begin, channels);
  maker.make(input, row, out);
  standardise(model.input_mean, model.input_scale, out);
  spaces.push_back(maker.space());
}

void LiveFuser::Seen::forget_first() {
  erase_first(rows, rows.size() / spaces.size());
  erase_first(spaces, 1);
  network.forget(1);
}

LiveFuser::LiveFuser(Fuser& fuser, std::size_t look_ahead)
    : fuser_(&fuser),
      kinect_{FuseFeatureMaker(fuser.model().layout), WindowNetwork(fuser.network())},
      both_{FuseFeatureMaker(fuser.model().layout), WindowNetwork(fuser.network())},
      filter_(fuser.model().layout, fuser.model().body),
      states_(fuser.model().layout.nodes.nodes.size()) {
  const Architecture& network = fuser.model().architecture;
  const std::size_t smoothed = fuser.model().smoothing ? smoothed_places : 0;
  const auto ahead = kinalign::look_ahead(network);
  ahead_ = ahead ? std::min(look_ahead, *ahead + smoothed) : look_ahead;
  behind_ = look_back(network).value_or(remembered_by_network) + smoothed_rows;
}

void LiveFuser::begin_headings() {
  // A new calibration may rotate the nodes' world, so the rotation between both worlds is estimated
  // again.
  yaw_.reset();
  filter_.reset();
}

void LiveFuser::add(const FuseInput& input) {
  append_input(waiting_, input);
  if (!yaw_) yaw_ = shared_heading(fuser_->model().layout, waiting_);
  if (!yaw_ && waiting_.frames() > most_waiting) {
    forget_first(waiting_);
    ++forgotten_;
  }
  if (!yaw_) return;
  const FuseInput ready = std::exchange(waiting_, {});
  for (std::size_t t = 0; t < ready.frames(); ++t) take(frame_at(ready, t));
}

void LiveFuser::answer(std::vector<FusedFramePose>& out) {
  if (unanswered() > ahead_) answer_rows(unanswered() - ahead_, out);
}

void LiveFuser::finish(std::vector<FusedFramePose>& out) {
  if (unanswered() > 0) answer_rows(unanswered(), out);
}

/// Moves one frame into the Kinect's world and appends it to the window.
void LiveFuser::take(FuseInput input) {
  turn_world(input.nodes, *yaw_);
  unexchange(fuser_->model().layout, input);
  append_input(window_, input);
  std::fill(input.nodes.valid.begin(), input.nodes.valid.end(), std::uint8_t{0});
  kinect_.make(fuser_->model(), input, 0);
}

/// Estimates the headings of rows before `end` from the network's answer to the Kinect alone. All
/// later rows get the newest headings.
void LiveFuser::find_headings(std::size_t end) {
  const std::size_t bones = fuser_->model().layout.nodes.bones.size();
  const std::size_t nodes = states_.size(), frames = window_.frames();
  const auto answers = kinect_.network.run(kinect_.rows, frames, frames, end);
  const FusedPose seen = fuser_->pose_of({kinect_.spaces, answers, next_, end});
  headings_.resize(next_ * nodes);
  for (std::size_t row = next_; row < end; ++row) {
    const FuseInput now = frame_at(window_, row);
    const std::size_t at = row - next_;
    filter_.step(now.nodes, 0,
                 directions_of_pose(filter_, now.kinect,
                                    std::span(seen.rotations).subspan(at * bones, bones),
                                    std::span(seen.root).subspan(at, 1)));
    for (std::size_t n = 0; n < nodes; ++n) states_[n] = filter_.state(n);
    append_to(headings_, states_);
  }
  while (headings_.size() < frames * nodes) append_to(headings_, states_);
}

/// The network's output for rows before `end`. Features of rows before next_ are already made.
/// Features of later rows are made again with new headings; only those before `answered` are final.
std::span<const float> LiveFuser::answers_to_both(const FuseInput& corrected, std::size_t answered,
                                                  std::size_t end) {
  const FuseModel& model = fuser_->model();
  const std::size_t frames = corrected.frames();
  both_.rows.resize(next_ * model.layout.channels());
  both_.spaces.resize(next_);
  for (std::size_t row = next_; row < answered; ++row) both_.make(model, corrected, row);
  const FuseFeatureMaker at_answered = both_.maker;
  for (std::size_t row = answered; row < frames; ++row) both_.make(model, corrected, row);
  both_.maker = at_answered;
  return both_.network.run(both_.rows, frames, next_, end);
}

/// Computes the poses of the next `count` rows and removes rows that no later frame needs.
void LiveFuser::answer_rows(std::size_t count, std::vector<FusedFramePose>& out) {
  const std::size_t bones = fuser_->model().layout.nodes.bones.size();
  const std::size_t frames = window_.frames(), end = next_ + count;
  find_headings(end);
  FuseInput corrected = window_;
  corrected.nodes = with_headings(std::move(corrected.nodes), headings_);
  const std::size_t last = std::min(frames, end + smoothed_places);
  const auto answers = answers_to_both(corrected, end, last);
  const std::size_t first = next_ - std::min(next_, smoothed_rows);
  const FusedPose pose = fuser_->measured_pose_of({both_.spaces, answers, first, last}, corrected);
  for (; next_ < end; ++next_) {
    const std::size_t at = next_ - first;
    out.push_back({row_of(pose.rotations, at, bones), pose.root[at], pose.place[at]});
  }
  for (; next_ > behind_; --next_) {
    forget_first(window_);
    kinect_.forget_first();
    both_.forget_first();
    erase_first(headings_, states_.size());
  }
}

}  // namespace kinalign
