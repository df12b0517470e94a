// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/pose/pose_model.h"

#include <nlohmann/json.hpp>

namespace kinalign {

namespace {

/// Throws if a member is missing or of another type.
Result<void> read_pose_header(const ModelHeader& header, const std::string& name, PoseModel& out) {
  if (out.facts.task != "pose") {
    return Failure(
        Error{name, 0, "a model for poses from inertial nodes", "task " + shown(out.facts.task)});
  }
  out.layout.rate_hz = header.at("rate_hz").get<double>();
  out.layout.nodes = header.at("input").at("nodes").get<std::vector<std::string>>();
  const auto channels = header.at("input").at("channels").get<std::string>();
  if (channels != "ours" && channels != "dip") {
    return Failure(Error{name, 0, "channels \"ours\" or \"dip\"", shown(channels)});
  }
  out.layout.inputs = channels == "dip" ? PoseInputs::dip : PoseInputs::ours;
  return {};
}

}  // namespace

std::string write_pose_model(const PoseModel& model) {
  const char* channels = model.layout.inputs == PoseInputs::dip ? "dip" : "ours";
  return write_body_model(model,
                          {{"rate_hz", model.layout.rate_hz},
                           {"input", {{"nodes", model.layout.nodes}, {"channels", channels}}}});
}

Result<PoseModel> read_pose_model(std::string_view bytes, const std::string& name) {
  PoseModel out;
  const auto read_own = [&](const ModelHeader& header) {
    return read_pose_header(header, name, out);
  };
  const auto channels = [&]() -> Result<std::size_t> {
    out.layout.bones = out.body.bones;
    KA_TRY(validate(out.layout));
    return out.layout.channels();
  };
  KA_TRY(read_body_model(bytes, name, out, read_own, channels));
  return out;
}

}  // namespace kinalign
