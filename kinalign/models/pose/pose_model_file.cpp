// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/model_file.h"
#include "kinalign/models/pose/pose_model.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace kinalign {

namespace {

constexpr std::size_t most_pose_joints = 1000;

ModelHeader pose_header_of(const PoseModel& model) {
  const PoseLayout& layout = model.layout;
  const Skeleton& skeleton = model.body.skeleton;
  ModelHeader offsets = ModelHeader::array();
  for (const Vec3& one : skeleton.rest_offsets) offsets.push_back({one.x(), one.y(), one.z()});
  return {
      {"rate_hz", layout.rate_hz},
      {"input",
       {{"nodes", layout.nodes}, {"channels", layout.inputs == PoseInputs::dip ? "dip" : "ours"}}},
      {"output",
       {{"bones", layout.bones},
        {"joints", skeleton.joint_names},
        {"parents", skeleton.parents},
        {"turned_by", model.body.turned_by},
        {"rest_offsets_m", std::move(offsets)},
        {"smoothing", model.smoothing}}}};
}

/// Throws where a member is missing or of another type.
Result<void> read_pose_header(const ModelHeader& header, const std::string& name, PoseModel& out) {
  out.facts = facts_of(header);
  if (out.facts.task != "pose") {
    return Failure(
        Error{name, 0, "a model for poses from inertial nodes", "task " + shown(out.facts.task)});
  }
  PoseLayout& layout = out.layout;
  layout.rate_hz = header.at("rate_hz").get<double>();
  layout.nodes = header.at("input").at("nodes").get<std::vector<std::string>>();
  const auto channels = header.at("input").at("channels").get<std::string>();
  if (channels != "ours" && channels != "dip") {
    return Failure(Error{name, 0, "channels \"ours\" or \"dip\"", shown(channels)});
  }
  layout.inputs = channels == "dip" ? PoseInputs::dip : PoseInputs::ours;
  const ModelHeader& output = header.at("output");
  layout.bones = output.at("bones").get<std::vector<std::string>>();
  out.body.bones = layout.bones;
  out.body.turned_by = output.at("turned_by").get<std::vector<int>>();
  Skeleton& skeleton = out.body.skeleton;
  skeleton.joint_names = output.at("joints").get<std::vector<std::string>>();
  skeleton.parents = output.at("parents").get<std::vector<int>>();
  for (const ModelHeader& one : output.at("rest_offsets_m")) {
    const auto offset = one.get<std::array<double, 3>>();
    skeleton.rest_offsets.emplace_back(offset[0], offset[1], offset[2]);
  }
  out.smoothing = output.at("smoothing").get<bool>();
  return {};
}

Result<void> check_parts(const PoseModel& model) {
  KA_TRY(validate(model.layout));
  if (model.body.skeleton.joints() > most_pose_joints) {
    return Failure(
        Error{"", 0, "1000 joints at most", std::to_string(model.body.skeleton.joints())});
  }
  KA_TRY(validate(model.body));
  for (const Vec3& offset : model.body.skeleton.rest_offsets) {
    if (!offset.allFinite()) return Failure(Error{"", 0, "bones with a length", "none"});
  }
  const bool scales = std::all_of(model.input_scale.begin(), model.input_scale.end(),
                                  [](float scale) { return std::isfinite(scale) && scale > 0.0F; });
  const std::size_t channels = model.layout.channels();
  if (model.input_mean.size() != channels || model.input_scale.size() != channels || !scales) {
    return Failure(Error{
        "", 0,
        "input.mean and input.scale of " + std::to_string(channels) + " channels, scales above 0",
        "others"});
  }
  return {};
}

}  // namespace

std::string write_pose_model(const PoseModel& model) {
  std::map<std::string, Tensor> tensors = model.tensors;
  tensors["input.mean"] = row_of(model.input_mean);
  tensors["input.scale"] = row_of(model.input_scale);
  return write_model_file(model.facts, pose_header_of(model), {{"net", model.architecture}},
                          std::move(tensors));
}

Result<PoseModel> read_pose_model(std::string_view bytes, const std::string& name) {
  TensorFile file = KA_TRY(read_safetensors(bytes, name));
  const ModelHeader header = KA_TRY(read_model_header(file, name));
  PoseModel out;
  try {
    KA_TRY(read_pose_header(header, name, out));
    out.architecture = KA_TRY(network_of(header, "net", name));
  } catch (const nlohmann::json::exception& fault) {
    return broken_header(name, fault);
  }
  out.input_mean = KA_TRY(take_row(file.tensors, "input.mean", name));
  out.input_scale = KA_TRY(take_row(file.tensors, "input.scale", name));
  out.tensors = std::move(file.tensors);
  if (auto sound = check_parts(out); !sound) {
    sound.error().file = name;
    return Failure(sound.error());
  }
  return out;
}

}  // namespace kinalign
