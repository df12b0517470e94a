// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/pose/body_model.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace kinalign {

namespace {

// A file may come from anywhere. These limits keep its numbers usable.
constexpr std::size_t most_body_joints = 1000;
constexpr double longest_bone_m = 100.0;

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

/// Throws the JSON library's exception if a member is missing or of another type.
void read_body(const ModelHeader& output, BodyModel& out) {
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
}

Result<void> check_body(const PoseBody& body) {
  if (body.skeleton.joints() > most_body_joints) {
    return Failure(Error{"", 0, "at most 1000 joints", std::to_string(body.skeleton.joints())});
  }
  KA_TRY(validate(body));
  for (const Vec3& offset : body.skeleton.rest_offsets) {
    if (!(offset.norm() <= longest_bone_m)) {
      return Failure(Error{"", 0, "bones of at most 100 m", "a longer bone"});
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

}  // namespace

std::string write_body_model(const BodyModel& model, ModelHeader own) {
  // The task's members come first, then the body: every task thus writes its header in one order.
  own["output"] = body_header(model.body, model.smoothing);
  std::map<std::string, Tensor> tensors = model.tensors;
  tensors["input.mean"] = row_of(model.input_mean);
  tensors["input.scale"] = row_of(model.input_scale);
  return write_model_file(model.facts, own, {{"net", model.architecture}}, std::move(tensors));
}

Result<void> read_body_model(std::string_view bytes, const std::string& name, BodyModel& out,
                             const std::function<Result<void>(const ModelHeader&)>& read_own,
                             const std::function<Result<std::size_t>()>& channels) {
  TensorFile file = KA_TRY(read_safetensors(bytes, name));
  const ModelHeader header = KA_TRY(read_model_header(file, name));
  try {
    out.facts = facts_of(header);
    KA_TRY(read_own(header));
    read_body(header.at("output"), out);
    out.architecture = KA_TRY(network_of(header, "net", name));
  } catch (const nlohmann::json::exception& fault) {
    return broken_header(name, fault);
  }
  out.input_mean = KA_TRY(take_row(file.tensors, "input.mean", name));
  out.input_scale = KA_TRY(take_row(file.tensors, "input.scale", name));
  out.tensors = std::move(file.tensors);
  // The parts are checked only after all are read: `channels` needs the body's bones.
  const auto fits = [&]() -> Result<void> {
    const std::size_t count = KA_TRY(channels());
    KA_TRY(check_body(out.body));
    return check_scales(count, out.input_mean, out.input_scale);
  };
  auto sound = fits();
  if (!sound) sound.error().file = name;
  return sound;
}

Result<Network> network_of_body(const BodyModel& model, std::size_t channels, std::size_t answers) {
  Network out = KA_TRY(Network::make(model.architecture, tensors_below(model.tensors, "net.")));
  if (out.inputs() == channels && out.outputs() == answers) return out;
  return Failure(Error{
      "", 0, std::to_string(channels) + " channels in and " + std::to_string(answers) + " out",
      std::to_string(out.inputs()) + " and " + std::to_string(out.outputs())});
}

}  // namespace kinalign
