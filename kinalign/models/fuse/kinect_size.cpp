// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/fuse/kinect_size.h"

#include "kinalign/models/joint_names.h"
#include "kinalign/motion/median.h"

#include <array>
#include <cmath>
#include <string_view>

namespace kinalign {

namespace {

/// A bone that a Kinect shows, and its mean length over UI-PRMD's seven people, m.
struct KinectBone {
  std::string_view from, to;
  double length;
};
constexpr std::array<KinectBone, 7> kinect_bones{{{"SpineBase", "SpineShoulder", 0.534},
                                                  {"ShoulderLeft", "ElbowLeft", 0.256},
                                                  {"ShoulderRight", "ElbowRight", 0.256},
                                                  {"HipLeft", "KneeLeft", 0.371},
                                                  {"HipRight", "KneeRight", 0.371},
                                                  {"KneeLeft", "AnkleLeft", 0.382},
                                                  {"KneeRight", "AnkleRight", 0.382}}};
/// Mean length of thigh plus shank of UI-PRMD's people, measured by Vicon, m.
constexpr double legs_of_them = 0.837;
constexpr std::size_t least_size_frames = 30;
constexpr std::uint8_t is_tracked = 2;

/// The median distance of two joints, m, over frames that track both; empty if fewer than 30 do.
std::optional<double> median_length(const JointFrames& kinect, std::size_t from, std::size_t to) {
  std::vector<double> lengths;
  for (std::size_t t = 0; t < kinect.frames(); ++t) {
    const std::size_t a = t * kinect.joints + from, b = t * kinect.joints + to;
    if (kinect.seen[a] != is_tracked || kinect.seen[b] != is_tracked) continue;
    double square = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto apart =
          static_cast<double>(kinect.positions[3 * a + k] - kinect.positions[3 * b + k]);
      square += apart * apart;
    }
    lengths.push_back(std::sqrt(square));
  }
  if (lengths.size() < least_size_frames) return std::nullopt;
  return upper_median(std::move(lengths));
}

}  // namespace

std::optional<double> legs_by_kinect(const std::vector<std::string>& joints,
                                     const JointFrames& kinect) {
  double measured = 0.0, compared = 0.0, all = 0.0;
  for (const KinectBone& bone : kinect_bones) {
    all += bone.length;
    const auto from = index_of(joints, bone.from), to = index_of(joints, bone.to);
    const auto seen = from && to ? median_length(kinect, *from, *to) : std::nullopt;
    if (!seen) continue;
    measured += *seen;
    compared += bone.length;
  }
  // One factor for the whole body: the sum of the measured bones, divided by the sum of the same
  // bones of UI-PRMD's people. Bones that the Kinect did not track are in neither sum.
  if (compared < 0.5 * all) return std::nullopt;
  return legs_of_them * measured / compared;
}

}  // namespace kinalign
