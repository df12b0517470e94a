// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/live/live_fuser.h"

#include "kinalign/infer/shapes.h"

#include <algorithm>
#include <utility>

namespace kinalign {

namespace {

constexpr std::size_t remembered_by_network = 60;  // of one that sees the whole sequence
constexpr std::size_t smoothed_places = 4;  // frames on each side, Smoothing{} of the root's place

template <class T>
void append_to(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

void append_input(FuseInput& all, const FuseInput& more) {
  all.nodes.nodes = more.nodes.nodes;
  append_to(all.nodes.orientation, more.nodes.orientation);
  append_to(all.nodes.acceleration, more.nodes.acceleration);
  append_to(all.nodes.angular_velocity, more.nodes.angular_velocity);
  append_to(all.nodes.valid, more.nodes.valid);
  all.kinect.joints = more.kinect.joints;
  append_to(all.kinect.positions, more.kinect.positions);
  append_to(all.kinect.seen, more.kinect.seen);
}

template <class T>
std::vector<T> row_of(const std::vector<T>& all, std::size_t row, std::size_t width) {
  const auto begin = all.begin() + static_cast<std::ptrdiff_t>(row * width);
  return {begin, begin + static_cast<std::ptrdiff_t>(width)};
}

FuseInput frame_at(const FuseInput& all, std::size_t t) {
  const std::size_t nodes = all.nodes.nodes, joints = all.kinect.joints;
  return {
      {nodes, row_of(all.nodes.orientation, t, 4 * nodes),
       row_of(all.nodes.acceleration, t, 3 * nodes),
       row_of(all.nodes.angular_velocity, t, 3 * nodes), row_of(all.nodes.valid, t, nodes)},
      {joints, row_of(all.kinect.positions, t, 3 * joints), row_of(all.kinect.seen, t, joints)}};
}

template <class T>
void erase_begin(std::vector<T>& all, std::size_t count) {
  all.erase(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
}

void forget_first(FuseInput& all) {
  const std::size_t nodes = all.nodes.nodes, joints = all.kinect.joints;
  erase_begin(all.nodes.orientation, 4 * nodes);
  erase_begin(all.nodes.acceleration, 3 * nodes);
  erase_begin(all.nodes.angular_velocity, 3 * nodes);
  erase_begin(all.nodes.valid, nodes);
  erase_begin(all.kinect.positions, 3 * joints);
  erase_begin(all.kinect.seen, joints);
}

}  // namespace

LiveFuser::LiveFuser(Fuser& fuser, std::size_t look_ahead)
    : fuser_(&fuser),
      filter_(fuser.model().layout, fuser.model().body),
      states_(fuser.model().layout.nodes.nodes.size()) {
  const Architecture& network = fuser.model().architecture;
  const std::size_t smoothed = fuser.model().smoothing ? smoothed_places : 0;
  const auto ahead = kinalign::look_ahead(network);
  ahead_ = ahead ? std::min(look_ahead, *ahead + smoothed) : look_ahead;
  behind_ = look_back(network).value_or(remembered_by_network) + smoothed_places;
}

void LiveFuser::begin_headings() {
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

/// One frame into the window, in the Kinect's world.
void LiveFuser::take(FuseInput input) {
  turn_world(input.nodes, *yaw_);
  unexchange(fuser_->model().layout, input);
  append_input(window_, input);
}

void LiveFuser::answer_rows(std::size_t count, std::vector<FusedFramePose>& out) {
  const std::size_t bones = fuser_->model().layout.nodes.bones.size();
  const std::size_t nodes = states_.size(), end = next_ + count;
  FuseInput kinect = window_;
  std::fill(kinect.nodes.valid.begin(), kinect.nodes.valid.end(), std::uint8_t{0});
  const FusedPose seen = fuser_->answer(kinect);
  std::vector<HeadingState> all;  // of each row; rows before have the headings of now, too
  for (std::size_t row = next_; row < end; ++row) {
    const FuseInput now = frame_at(window_, row);
    filter_.step(now.nodes, 0,
                 directions_of_pose(filter_, now.kinect,
                                    std::span(seen.rotations).subspan(row * bones, bones),
                                    std::span(seen.root).subspan(row, 1)));
    for (std::size_t n = 0; n < nodes; ++n) states_[n] = filter_.state(n);
    while (all.size() < row * nodes) append_to(all, states_);
    append_to(all, states_);
  }
  while (all.size() < window_.frames() * nodes) append_to(all, states_);
  const FusedPose pose = fuser_->solve(window_, all);
  for (; next_ < end; ++next_) {
    out.push_back({row_of(pose.rotations, next_, bones), pose.root[next_], pose.place[next_]});
  }
  for (; next_ > behind_; --next_) forget_first(window_);
}

}  // namespace kinalign
