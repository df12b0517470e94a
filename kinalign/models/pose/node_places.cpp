// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/pose/node_places.h"

#include "kinalign/core/find_named.h"
#include "kinalign/motion/index_of.h"

#include <algorithm>
#include <cctype>

namespace kinalign {

namespace {

using Direction = std::array<double, 3>;

// In CMU's skeletons the ankle joint of a standing person lies behind the knee: the shank is 12 to
// 31 degrees off the vertical in the standing poses of 16 people, 20 on average. In a recorded walk
// with optical truth (UNSW), ankles were 11 to 16 cm off with these 20 degrees, and 18 to 20 cm off
// without them. For a simulated suit, whose shanks are vertical, they were 13 cm off with the 20
// degrees and 7 cm without.
constexpr Direction cmu_shank{0.0, -0.94, -0.34};

constexpr std::array<WornPlace, 6> places{{
    {"waist", "root", {}, {0, 1, 0}, {0, 0, -1}},
    {"wrist_left", "lwrist", {1, 0, 0}, {1, 0, 0}, {0, 1, 0}, true},
    {"wrist_right", "rwrist", {-1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, true},
    {"ankle_left", "ltibia", cmu_shank, {0, -1, 0}, {0.6, 0, 0.8}},
    {"ankle_right", "rtibia", cmu_shank, {0, -1, 0}, {-0.6, 0, 0.8}},
    {"head", "head", {}, {0, 1, 0}, {0, 0, -1}},
}};

/// Words for a place, without its side, in lower case and without separators.
struct PlaceWord {
  std::string_view word, place;
};

constexpr std::array<PlaceWord, 18> place_words{{{"waist", "waist"},
                                                 {"pelvis", "waist"},
                                                 {"hip", "waist"},
                                                 {"hips", "waist"},
                                                 {"sacrum", "waist"},
                                                 {"root", "waist"},
                                                 {"wrist", "wrist"},
                                                 {"forearm", "wrist"},
                                                 {"lowerarm", "wrist"},
                                                 {"ankle", "ankle"},
                                                 {"shank", "ankle"},
                                                 {"shin", "ankle"},
                                                 {"calf", "ankle"},
                                                 {"tibia", "ankle"},
                                                 {"lowerleg", "ankle"},
                                                 {"lowleg", "ankle"},
                                                 {"leg", "ankle"},
                                                 {"head", "head"}}};

Vec3 vec3_of(const Direction& direction) { return {direction[0], direction[1], direction[2]}; }

bool is_capital(char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; }

/// Splits a name into lower-case words: "LeftLowerLeg", "LEFT_LOWER_LEG" and "left lower leg" give
/// left, lower, leg.
std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> out;
  // A new word begins after any other character, and at a capital after a small letter.
  bool goes_on = false, was_small = false;
  for (const char c : name) {
    if (std::isalpha(static_cast<unsigned char>(c)) == 0) {
      goes_on = was_small = false;
      continue;
    }
    if (!goes_on || (is_capital(c) && was_small)) out.emplace_back();
    out.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    goes_on = true;
    was_small = !is_capital(c);
  }
  return out;
}

}  // namespace

std::span<const WornPlace> worn_places() { return places; }

const WornPlace* worn_place(std::string_view name) { return find_named(places, name); }

std::string_view place_called(std::string_view name) {
  std::string side, rest;
  for (const std::string& word : words_of(name)) {
    if (word == "left" || word == "l") {
      side = "_left";
    } else if (word == "right" || word == "r") {
      side = "_right";
    } else {
      rest += word;
    }
  }
  for (const PlaceWord& one : place_words) {
    if (one.word != rest) continue;
    const WornPlace* place = worn_place(std::string(one.place) + side);
    return place == nullptr ? "" : place->name;
  }
  return "";
}

std::optional<std::size_t> node_at(std::span<const std::string> names, std::string_view place) {
  if (const auto at = index_of(names, place)) return at;
  const auto found = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
    return place_called(name) == place;
  });
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

Quat worn_in_t_pose(const WornPlace& place) {
  const Vec3 along = vec3_of(place.along), outward = vec3_of(place.outward);
  Eigen::Matrix3d axes;
  axes << along, outward.cross(along), outward;
  return Quat(axes);
}

Result<std::vector<Quat>> t_pose_rotations(const PoseLayout& layout, const Skeleton& body) {
  std::vector<Quat> out;
  for (const std::string& node : layout.nodes) {
    const WornPlace* place = worn_place(node);
    if (place == nullptr) {
      return Failure(Error{"", 0, "a model for nodes on known places of the body", shown(node)});
    }
    const Vec3 direction = vec3_of(place->t_pose);
    // A T-pose does not fix the directions of the bones at waist and head.
    if (direction.isZero()) {
      out.push_back(Quat::Identity());
      continue;
    }
    const auto bone = std::find(body.joint_names.begin(), body.joint_names.end(), place->bone);
    const auto end = std::find(body.parents.begin(), body.parents.end(),
                               static_cast<int>(bone - body.joint_names.begin()));
    if (bone == body.joint_names.end() || end == body.parents.end()) {
      return Failure(
          Error{"", 0, "a body with a bone " + std::string(place->bone) + " for " + node, "none"});
    }
    const Vec3& at_rest = body.rest_offsets[static_cast<std::size_t>(end - body.parents.begin())];
    out.push_back(Quat::FromTwoVectors(at_rest, direction));
  }
  return out;
}

}  // namespace kinalign
