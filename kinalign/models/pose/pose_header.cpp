// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/pose/pose_header.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace kinalign {

namespace {

constexpr std::size_t most_body_joints = 1000;
constexpr double longest_bone_m = 100.0;

}  // namespace

ModelHeader body_header(const PoseBody& body, bool smoothing) {
  ModelHeader offsets = ModelHeader::array();
  for (const Vec3& one : body.skeleton.rest_offsets) offsets.push_back({one.x(), one.y(), one.z()});
  return {{"bones", body.bones},
          {"joints", body.skeleton.joint_names},
          {"parents", body.skeleton.parents},
          {"turned_by", body.turned_by},
          {"rest_offsets_m", std::move(offsets)},
          {"smoothing", smoothing}};
}

BodyOfHeader body_of_header(const ModelHeader& output) {
  BodyOfHeader out;
  out.body.bones = output.at("bones").get<std::vector<std::string>>();
  out.body.turned_by = output.at("turned_by").get<std::vector<int>>();
  Skeleton& skeleton = out.body.skeleton;
  skeleton.joint_names = output.at("joints").get<std::vector<std::string>>();
  skeleton.parents = output.at("parents").get<std::vector<int>>();
  for (const ModelHeader& one : output.at("rest_offsets_m")) {
    const auto offset = one.get<std::array<double, 3>>();
    skeleton.rest_offsets.emplace_back(offset[0], offset[1], offset[2]);
  }
  out.smoothing = output.at("smoothing").get<bool>();
  return out;
}

Result<void> check_body(const PoseBody& body) {
  if (body.skeleton.joints() > most_body_joints) {
    return Failure(Error{"", 0, "1000 joints at most", std::to_string(body.skeleton.joints())});
  }
  KA_TRY(validate(body));
  for (const Vec3& offset : body.skeleton.rest_offsets) {
    if (!(offset.norm() <= longest_bone_m)) {
      return Failure(Error{"", 0, "bones of at most 100 m", "another length"});
    }
  }
  return {};
}

Result<void> check_scales(std::size_t channels, const std::vector<float>& mean,
                          const std::vector<float>& scale) {
  const bool sound =
      std::all_of(scale.begin(), scale.end(),
                  [](float one) { return std::isfinite(one) && one > 0.0F; }) &&
      std::all_of(mean.begin(), mean.end(), [](float one) { return std::isfinite(one); });
  if (mean.size() == channels && scale.size() == channels && sound) return {};
  return Failure(Error{
      "", 0,
      "input.mean and input.scale of " + std::to_string(channels) + " channels, scales above 0",
      "others"});
}

}  // namespace kinalign
