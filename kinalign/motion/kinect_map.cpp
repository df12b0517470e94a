// SPDX-License-Identifier: Apache-2.0
// Sources of the tables. Heights above the hips, cm: Kinect SpineMid 32, SpineShoulder 55, Neck 63,
// Head 78 (means of 18 recordings). Perception Neuron, for a person of 175 cm: Spine1 24.0, Spine2
// 34.1, Spine3 43.9, Neck 54.3, Head 63.7, end 79.7. Axis Studio: Spine1 25.1, Spine2 37.4, Neck
// 55.8, Neck1 60.6, Head 65.3, end 81.2. Kinect hips are 15.7 cm apart, Perception Neuron's 18.5
// cm. A Kinect's hip is therefore 15 % of the way from the suit's hip to the other hip. CMU's names
// are those of its BVH files by cgspeed.
#include "kinalign/motion/kinect_map.h"

#include "kinalign/motion/index_of.h"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

namespace kinalign {

namespace {

struct Way {
  std::string_view from;
  double share = 0.0;
  std::string_view to = {};  // empty: the end site of `from`
};
using Table = std::array<Way, kinect_joints.size()>;

/// The table for both hierarchies of Perception Neuron, which have the same limbs. The arguments
/// are the joints of the spine.
constexpr Table limbs(const Way& mid, const Way& shoulder, const Way& neck, const Way& head) {
  return {{{"Hips"},
           mid,
           neck,
           head,
           {"LeftArm"},
           {"LeftForeArm"},
           {"LeftHand"},
           {"LeftInHandMiddle", 0.5, "LeftHandMiddle1"},
           {"RightArm"},
           {"RightForeArm"},
           {"RightHand"},
           {"RightInHandMiddle", 0.5, "RightHandMiddle1"},
           {"LeftUpLeg", 0.15, "RightUpLeg"},
           {"LeftLeg"},
           {"LeftFoot"},
           {"LeftFoot", 0.7},
           {"RightUpLeg", 0.15, "LeftUpLeg"},
           {"RightLeg"},
           {"RightFoot"},
           {"RightFoot", 0.7},
           shoulder,
           {"LeftHandMiddle3", 1.0},
           {"LeftHandThumb2", 0.5, "LeftHandThumb3"},
           {"RightHandMiddle3", 1.0},
           {"RightHandThumb2", 0.5, "RightHandThumb3"}}};
}

constexpr Table legacy = limbs({"Spine2"}, {"Neck", 0.0, "Spine3"}, {"Head"}, {"Head", 0.87});
constexpr Table studio = limbs({"Spine1", 0.56, "Spine2"}, {"Neck", 0.0, "Neck1"},
                               {"Neck1", 0.5, "Head"}, {"Head", 0.8});
constexpr Table cmu{{{"Hips"},       {"Spine"},
                     {"Neck"},       {"Head"},
                     {"LeftArm"},    {"LeftForeArm"},
                     {"LeftHand"},   {"LeftFingerBase"},
                     {"RightArm"},   {"RightForeArm"},
                     {"RightHand"},  {"RightFingerBase"},
                     {"LeftUpLeg"},  {"LeftLeg"},
                     {"LeftFoot"},   {"LeftToeBase"},
                     {"RightUpLeg"}, {"RightLeg"},
                     {"RightFoot"},  {"RightToeBase"},
                     {"Spine1"},     {"LeftHandIndex1", 1.0},
                     {"LThumb"},     {"RightHandIndex1", 1.0},
                     {"RThumb"}}};

struct Known {
  std::string_view name;
  const Table& table;
};
constexpr std::array<Known, 3> known{
    {{"Perception Neuron's", legacy}, {"Axis Studio's", studio}, {"CMU's", cmu}}};

const EndSite* find_end(const Skeleton& skeleton, std::size_t joint) {
  const auto found =
      std::find_if(skeleton.end_sites.begin(), skeleton.end_sites.end(),
                   [&](const EndSite& end) { return end.parent == static_cast<int>(joint); });
  return found == skeleton.end_sites.end() ? nullptr : &*found;
}

/// Fills `place`. Returns the name of the missing joint or end site; empty if none is missing.
std::string fill(const Skeleton& skeleton, const Way& way, KinectPlace& place) {
  const auto from = index_of(skeleton.joint_names, way.from);
  if (!from) return std::string(way.from);
  // With share 0 and no vector `along`, the place is the joint itself.
  place = {*from, *from, 0.0, Vec3::Zero()};
  if (!way.to.empty()) {
    const auto to = index_of(skeleton.joint_names, way.to);
    if (!to) return std::string(way.to);
    place.towards = *to;
    place.share = way.share;
  } else if (way.share > 0.0) {
    const EndSite* end = find_end(skeleton, *from);
    if (end == nullptr) return "an end site of " + std::string(way.from);
    place.along = way.share * end->offset;
  }
  return {};
}

struct Trial {
  KinectMap map;
  std::vector<std::string> missing;  // each name once
};

Trial tried(const Skeleton& skeleton, const Table& table) {
  Trial trial;
  for (std::size_t k = 0; k < table.size(); ++k) {
    const std::string lack = fill(skeleton, table[k], trial.map.places[k]);
    const bool new_one =
        std::find(trial.missing.begin(), trial.missing.end(), lack) == trial.missing.end();
    if (!lack.empty() && new_one) trial.missing.push_back(lack);
  }
  return trial;
}

}  // namespace

Result<KinectMap> kinect_map(const Skeleton& skeleton) {
  std::optional<Trial> best;
  std::string_view best_name;
  // If no table fits, the message is about the table with the fewest missing joints.
  for (const auto& [name, table] : known) {
    Trial trial = tried(skeleton, table);
    if (best && trial.missing.size() >= best->missing.size()) continue;
    best = std::move(trial);
    best_name = name;
  }
  if (best->missing.empty()) return best->map;
  std::string found = "no joint called ";
  for (std::size_t i = 0; i < best->missing.size(); ++i) {
    found += (i == 0 ? "" : ", ") + best->missing[i];
  }
  return Failure(Error{"", 0,
                       "a skeleton with the joints of Perception Neuron, Axis Studio or CMU, here "
                       "nearest to " +
                           std::string(best_name),
                       found});
}

void kinect_positions(const KinectMap& map, const GlobalPose& pose, std::span<double> out) {
  for (std::size_t k = 0; k < map.places.size(); ++k) {
    const KinectPlace& place = map.places[k];
    const Vec3& from = pose.positions[place.joint];
    vec3(out, k) = from + place.share * (pose.positions[place.towards] - from) +
                   pose.rotations[place.joint] * place.along;
  }
}

}  // namespace kinalign
