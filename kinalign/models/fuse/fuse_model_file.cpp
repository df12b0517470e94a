// SPDX-License-Identifier: Apache-2.0
#include "kinalign/models/fuse/fuse_model.h"

#include <nlohmann/json.hpp>

namespace kinalign {

namespace {

/// Throws if a member is missing or of another type.
Result<void> read_fuse_header(const ModelHeader& header, const std::string& name, FuseModel& out) {
  if (out.facts.task != "fuse") {
    return Failure(
        Error{name, 0, "a model for a Kinect and nodes together", "task " + shown(out.facts.task)});
  }
  out.layout.nodes.rate_hz = header.at("rate_hz").get<double>();
  out.layout.nodes.nodes = header.at("input").at("nodes").get<std::vector<std::string>>();
  out.layout.joints = header.at("input").at("joints").get<std::vector<std::string>>();
  return {};
}

Result<std::size_t> checked_channels(const FuseLayout& layout) {
  if (layout.joints.size() > fuse_joints.size()) {
    return Failure(Error{"", 0, std::to_string(fuse_joints.size()) + " joints at most",
                         std::to_string(layout.joints.size())});
  }
  KA_TRY(validate(layout));
  return layout.channels();
}

}  // namespace

std::string write_fuse_model(const FuseModel& model) {
  const FuseLayout& layout = model.layout;
  return write_body_model(model,
                          {{"rate_hz", layout.nodes.rate_hz},
                           {"input", {{"nodes", layout.nodes.nodes}, {"joints", layout.joints}}}});
}

// The bones stand in the file's body and not in its layout, so the layout gets them after the body
// is read.
Result<FuseModel> read_fuse_model(std::string_view bytes, const std::string& name) {
  FuseModel out;
  const auto read_own = [&](const ModelHeader& header) {
    return read_fuse_header(header, name, out);
  };
  const auto channels = [&] {
    out.layout.nodes.bones = out.body.bones;
    return checked_channels(out.layout);
  };
  KA_TRY(read_body_model(bytes, name, out, read_own, channels));
  return out;
}

}  // namespace kinalign
