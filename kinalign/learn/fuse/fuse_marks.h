// SPDX-License-Identifier: Apache-2.0
// Measures how well a pose is found from a Kinect, from nodes, and from both, for people who were
// not in the training. Limbs of the Kinect are hidden repeatedly. Errors of the devices are the
// same for every method.
#pragma once

#include "kinalign/learn/fuse/fuse_data.h"
#include "kinalign/learn/fuse/fuse_draws.h"
#include "kinalign/models/fuse/fuse_model.h"

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace kinalign {

/// Distances are means over joints and frames, with positions relative to the root and orientations
/// in the world. For nodes alone the heading of each sequence is taken from the truth, because
/// nodes cannot measure it.
struct FuseErrors {
  double all_cm = 0.0;
  /// Joints that the Kinect does not track or puts more than 20 cm off.
  double hidden_cm = 0.0;
  double seen_trunk_cm = 0.0, seen_arms_cm = 0.0, seen_legs_cm = 0.0;  // the other joints
  double place_cm = 0.0;  // of the root in the Kinect's world; not defined for nodes alone
  double sip_deg = 0.0;   // rotation of thighs and upper arms relative to the root
  /// `frames`: number of frames. `hidden`: number of hidden joints, summed over frames.
  std::size_t frames = 0, hidden = 0;
};

/// The mean errors over all frames, and those of each person, because people differ.
struct FuseMark {
  Devices devices = Devices::both;
  FuseErrors all{};
  std::map<std::string, FuseErrors> people{};  // by person
};

/// A method as a function from both devices' data to a pose.
using Fusion = std::function<FusedPose(const FuseInput& input)>;

/// One result for each entry of `devices`, over data.tested. Fails if there is no test person.
/// The method gets whole sessions, because headings need time; scores are summed over sequences.
/// `data` is copied, because limbs of its Kinects are hidden for all methods in the same way.
Result<std::vector<FuseMark>> fuse_marks(const Fusion& fusion, const FuseLayout& layout,
                                         const FuseData& data, const std::vector<Devices>& devices);

/// Heading errors of one node, over the test people's sessions. A session is a person's sequences
/// one after another.
struct HeadingMark {
  std::string node;
  /// Mean absolute error at the start, and after 60 s with a Kinect.
  double before_deg = 0.0, after_deg = 0.0;
  double worst_deg = 0.0;  // largest error of any person after 60 s
  /// Error after 60 s for each person whose session is long enough.
  std::map<std::string, double> people{};
};

/// A function that gives the headings [T,N] of nodes in front of a Kinect.
using HeadingsOf = std::function<std::vector<HeadingState>(const FuseInput& input)>;

/// Headings have errors of up to 20 degrees at the start. Only the first 60 s of a session are
/// used.
std::vector<HeadingMark> heading_marks(const HeadingsOf& headings, const FuseLayout& layout,
                                       const FuseData& data);

}  // namespace kinalign
