// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/fuse/fuse_model.h"
#include "kinalign/models/model_file.h"
#include "kinalign/models/pose/pose_header.h"

#include <nlohmann/json.hpp>

#include <utility>

namespace kinalign {

namespace {

ModelHeader fuse_header_of(const FuseModel& model) {
  return {{"rate_hz", model.layout.nodes.rate_hz},
          {"input", {{"nodes", model.layout.nodes.nodes}, {"joints", model.layout.joints}}},
          {"output", body_header(model.body, model.smoothing)}};
}

/// Throws where a member is missing or of another type.
Result<void> read_fuse_header(const ModelHeader& header, const std::string& name, FuseModel& out) {
  out.facts = facts_of(header);
  if (out.facts.task != "fuse") {
    return Failure(
        Error{name, 0, "a model for a Kinect and nodes together", "task " + shown(out.facts.task)});
  }
  out.layout.nodes.rate_hz = header.at("rate_hz").get<double>();
  out.layout.nodes.nodes = header.at("input").at("nodes").get<std::vector<std::string>>();
  out.layout.joints = header.at("input").at("joints").get<std::vector<std::string>>();
  BodyOfHeader body = body_of_header(header.at("output"));
  out.body = std::move(body.body);
  out.smoothing = body.smoothing;
  out.layout.nodes.bones = out.body.bones;
  return {};
}

Result<void> check_fuse_parts(const FuseModel& model) {
  if (model.layout.joints.size() > fuse_joints.size()) {
    return Failure(Error{"", 0, std::to_string(fuse_joints.size()) + " joints at most",
                         std::to_string(model.layout.joints.size())});
  }
  KA_TRY(validate(model.layout));
  KA_TRY(check_body(model.body));
  return check_scales(model.layout.channels(), model.input_mean, model.input_scale);
}

}  // namespace

std::string write_fuse_model(const FuseModel& model) {
  std::map<std::string, Tensor> tensors = model.tensors;
  tensors["input.mean"] = row_of(model.input_mean);
  tensors["input.scale"] = row_of(model.input_scale);
  return write_model_file(model.facts, fuse_header_of(model), {{"net", model.architecture}},
                          std::move(tensors));
}

Result<FuseModel> read_fuse_model(std::string_view bytes, const std::string& name) {
  TensorFile file = KA_TRY(read_safetensors(bytes, name));
  const ModelHeader header = KA_TRY(read_model_header(file, name));
  FuseModel out;
  try {
    KA_TRY(read_fuse_header(header, name, out));
    out.architecture = KA_TRY(network_of(header, "net", name));
  } catch (const nlohmann::json::exception& fault) {
    return broken_header(name, fault);
  }
  out.input_mean = KA_TRY(take_row(file.tensors, "input.mean", name));
  out.input_scale = KA_TRY(take_row(file.tensors, "input.scale", name));
  out.tensors = std::move(file.tensors);
  if (auto sound = check_fuse_parts(out); !sound) {
    sound.error().file = name;
    return Failure(sound.error());
  }
  return out;
}

}  // namespace kinalign
