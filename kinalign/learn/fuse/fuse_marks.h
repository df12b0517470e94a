// SPDX-License-Identifier: Apache-2.0
// How well a pose is found by a Kinect, by nodes, and by both, on people that were not learnt from.
// Limbs of the Kinect are hidden again and again; errors of devices are the same for every method.
#pragma once

#include "kinalign/learn/fuse/fuse_data.h"
#include "kinalign/learn/fuse/fuse_draws.h"
#include "kinalign/models/fuse/fuse_model.h"

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace kinalign {

/// Distances are means over joints and frames, about the root and in the world. Of nodes alone the
/// heading of a whole sequence is taken from the truth: they cannot know it.
struct FuseErrors {
  double all_cm = 0.0;
  /// Joints that the Kinect does not track, or that it puts more than 20 cm off.
  double hidden_cm = 0.0;
  double seen_trunk_cm = 0.0, seen_arms_cm = 0.0, seen_legs_cm = 0.0;  // all others
  double place_cm = 0.0;               // of the root in the Kinect's world; not of nodes alone
  double sip_deg = 0.0;                // global rotation of thighs and upper arms against the root
  std::size_t frames = 0, hidden = 0;  // frames; joints in frames
};

struct FuseMark {
  Devices devices = Devices::both;
  FuseErrors all{};
  std::map<std::string, FuseErrors> people{};  // by person
};

/// A method as a function from both devices, as they came, to a pose.
using Fusion = std::function<FusedPose(const FuseInput& input)>;

/// A row for each of `devices`, over data.tested. Fails where nobody is there to be tested.
Result<std::vector<FuseMark>> fuse_marks(const Fusion& fusion, const FuseLayout& layout,
                                         const FuseData& data, const std::vector<Devices>& devices);

/// How far headings are off, over the test people's sessions (their sequences one behind the
/// other).
struct HeadingMark {
  std::string node;
  double before_deg = 0.0, after_deg = 0.0;  // mean size, at first; after 60 s with a Kinect
  double worst_deg = 0.0;                    // of all people, after 60 s
  std::map<std::string, double> people{};    // whose sessions are that long: after 60 s
};

/// Headings [T,N] of nodes before a Kinect.
using HeadingsOf = std::function<std::vector<HeadingState>(const FuseInput& input)>;

/// Headings are off by up to 20 degrees at first. Only the first 60 s of a session are shown.
std::vector<HeadingMark> heading_marks(const HeadingsOf& headings, const FuseLayout& layout,
                                       const FuseData& data);

}  // namespace kinalign
