// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/model_file.h"
#include "kinalign/models/pose/pose_header.h"
#include "kinalign/models/pose/pose_model.h"

#include <nlohmann/json.hpp>

#include <utility>

namespace kinalign {

namespace {

ModelHeader pose_header_of(const PoseModel& model) {
  const PoseLayout& layout = model.layout;
  return {
      {"rate_hz", layout.rate_hz},
      {"input",
       {{"nodes", layout.nodes}, {"channels", layout.inputs == PoseInputs::dip ? "dip" : "ours"}}},
      {"output", body_header(model.body, model.smoothing)}};
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
  BodyOfHeader body = body_of_header(header.at("output"));
  out.body = std::move(body.body);
  out.smoothing = body.smoothing;
  layout.bones = out.body.bones;
  return {};
}

Result<void> check_parts(const PoseModel& model) {
  KA_TRY(validate(model.layout));
  KA_TRY(check_body(model.body));
  return check_scales(model.layout.channels(), model.input_mean, model.input_scale);
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
