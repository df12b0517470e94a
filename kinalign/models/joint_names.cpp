// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/joint_names.h"

#include "kinalign/core/find_named.h"
#include "kinalign/motion/kinect_joints.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace kinalign {

namespace {

struct Word {
  std::string_view name, kinect;
};

/// UI-PRMD's hierarchy names a joint after the bone that begins there, except at the head and the
/// toes: "FootLeft" is the ankle.
constexpr std::array<Word, 20> prmd_words{{{"Waist", "SpineBase"},
                                           {"Spine", "SpineMid"},
                                           {"Chest", "SpineShoulder"},
                                           {"Head", "Neck"},
                                           {"HeadTip", "Head"},
                                           {"Neck", "NeckBase"},
                                           {"UpperArmLeft", "ShoulderLeft"},
                                           {"ForearmLeft", "ElbowLeft"},
                                           {"HandLeft", "WristLeft"},
                                           {"UpperLegLeft", "HipLeft"},
                                           {"LowerLegLeft", "KneeLeft"},
                                           {"FootLeft", "AnkleLeft"},
                                           {"ToesLeft", "FootLeft"},
                                           {"UpperArmRight", "ShoulderRight"},
                                           {"ForearmRight", "ElbowRight"},
                                           {"HandRight", "WristRight"},
                                           {"UpperLegRight", "HipRight"},
                                           {"LowerLegRight", "KneeRight"},
                                           {"FootRight", "AnkleRight"},
                                           {"ToesRight", "FootRight"}}};

/// The names of usual mocap suits. "Neck1" becomes "NeckTop", and UI-PRMD's "Neck" becomes
/// "NeckBase". A Kinect has no joints at these places, so none of its names fits.
constexpr std::array<Word, 22> mocap_words{{{"Hips", "SpineBase"},
                                            {"Spine1", "SpineMid"},
                                            {"Spine3", "SpineShoulder"},
                                            {"LeftUpLeg", "HipLeft"},
                                            {"RightUpLeg", "HipRight"},
                                            {"LeftLeg", "KneeLeft"},
                                            {"RightLeg", "KneeRight"},
                                            {"LeftFoot", "AnkleLeft"},
                                            {"RightFoot", "AnkleRight"},
                                            {"LeftToeBase", "FootLeft"},
                                            {"RightToeBase", "FootRight"},
                                            {"LeftArm", "ShoulderLeft"},
                                            {"RightArm", "ShoulderRight"},
                                            {"LeftForeArm", "ElbowLeft"},
                                            {"RightForeArm", "ElbowRight"},
                                            {"LeftHand", "WristLeft"},
                                            {"RightHand", "WristRight"},
                                            {"Head", "Head"},
                                            {"LeftHandMiddle1", "HandLeft"},
                                            {"RightHandMiddle1", "HandRight"},
                                            {"Neck", "Neck"},
                                            {"Neck1", "NeckTop"}}};

template <std::size_t N>
std::string translated(const std::array<Word, N>& words, const std::string& name) {
  const Word* const found = find_named(words, name);
  return found == nullptr ? name : std::string(found->kinect);
}

}  // namespace

std::vector<std::string> kinect_names(const std::vector<std::string>& names) {
  // Each vocabulary is recognised by its root. The two must not be mixed: "Head" means the neck in
  // UI-PRMD, and the head in a suit.
  if (index_of(names, "SpineBase")) return names;
  const bool prmd = index_of(names, "Waist").has_value();
  std::vector<std::string> out;
  for (const std::string& name : names) {
    const std::string word = prmd ? translated(prmd_words, name) : translated(mocap_words, name);
    out.push_back(index_of(out, word) ? name : word);
  }
  return out;
}

std::vector<int> kinect_parents_of(const std::vector<std::string>& names) {
  std::vector<int> out(names.size(), -1);
  for (std::size_t j = 0; j < names.size(); ++j) {
    const auto known = std::find(kinect_joints.begin(), kinect_joints.end(), names[j]);
    if (known == kinect_joints.end()) continue;
    // Walks up the Kinect's own tree to the first joint among `names`: without a neck, the head's
    // parent is the shoulders' joint.
    auto at = static_cast<std::size_t>(known - kinect_joints.begin());
    while (out[j] < 0 && kinect_parents[at] != at) {
      at = kinect_parents[at];
      if (const auto parent = index_of(names, std::string(kinect_joints[at]))) {
        out[j] = static_cast<int>(*parent);
      }
    }
  }
  return out;
}

}  // namespace kinalign
