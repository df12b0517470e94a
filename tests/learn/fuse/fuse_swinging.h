// SPDX-License-Identifier: Apache-2.0
// A person who swings before a Kinect, as training data for fusion.
#pragma once

#include "tests/learn/pose/swinging.h"

#include "kinalign/learn/fuse/fuse_data.h"

namespace kinalign {

inline FuseData swinging_before_kinect(std::size_t frames = 64) {
  FuseData out;
  out.pose = swinging_data();
  out.pose.learnt = {swinging(frames, 1)};
  out.pose.judged = {swinging(frames, 2)};
  out.pose.tested = {swinging(frames, 3)};
  out.learnt = {{simulated_kinect(out.pose.body, out.pose.learnt[0], 1, 1, 1)}};
  out.judged = {{simulated_kinect(out.pose.body, out.pose.judged[0], 1, 1, 2)}};
  out.tested = {{simulated_kinect(out.pose.body, out.pose.tested[0], 1, 1, 3)}};
  return out;
}

}  // namespace kinalign
