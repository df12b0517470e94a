// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/learn/fused_input.h"

#include "kinalign/models/even_grid.h"
#include "kinalign/models/fuse/kinect_size.h"
#include "kinalign/models/joint_names.h"
#include "kinalign/models/pose/own_body.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>

namespace kinalign {

namespace {

constexpr double longest_kinect_gap_s = 0.2;  // samples that are further apart are not interpolated

/// The time from the first stamp of either device to the last one. It includes stretches with only
/// one of the devices, in which the model uses that device alone.
EvenSpan span_of_both(const BothDevices& both, const NodeChoice& choice, double rate_hz) {
  Time first = both.kinect.frames.stamps.front(), last = both.kinect.frames.stamps.back();
  for (const auto& node : choice) {
    if (!node) continue;
    const auto& stamps = both.nodes.tracks[*node].stamps;
    first = std::min(first, stamps.front());
    last = std::max(last, stamps.back());
  }
  return span_of(first, last, rate_hz);
}

}  // namespace

Result<FusedInput> fused_input(const FuseModel& model, BothDevices both, const WornWords& worn) {
  const FuseLayout& layout = model.layout;
  FusedInput out;
  // span_of_both() needs the stamps of the nodes' tracks, so the nodes are chosen before the tracks
  // are moved.
  const NodeChoice choice = KA_TRY(choose(layout.nodes, both.nodes));
  if (both.kinect.frames.stamps.size() < 2) {
    return Failure(Error{"", 0, "a Kinect with at least two frames", "fewer frames"});
  }
  const EvenSpan span = span_of_both(both, choice, layout.nodes.rate_hz);
  out.start = span.start;
  out.kinect = both.kinect.stream;
  // Only the names are kept; the tracks are large and are moved into the calibration.
  out.nodes = {both.nodes.stream, both.nodes.names, {}, {}};
  out.posed = KA_TRY(
      calibrated_nodes(layout.nodes, model.body.skeleton, std::move(both.nodes), worn, span));
  out.input.nodes = on_bones(out.posed.calibration, out.posed.even.worn);
  EvenFrames seen =
      KA_TRY(even_frames(layout.joints, kinect_names(both.kinect.joints), both.kinect.frames,
                         {layout.nodes.rate_hz, longest_kinect_gap_s, span}));
  out.warnings = warnings_of(both.kinect, seen);
  out.input.kinect = std::move(seen.body);
  // The coordinates of the nodes have another heading than those of the Kinect. The difference is
  // computed from the time in which both devices see the person.
  const auto yaw = shared_heading(layout, out.input);
  if (!yaw) {
    return Failure(Error{"", 0,
                         "a second in which the Kinect sees the person and the waist's node sends",
                         "no such second (denoise and pose use one device alone)"});
  }
  turn_world(out.input.nodes, *yaw);
  // The length of the person's legs is estimated from all bones that the Kinect sees well
  // (kinect_size.h). The ratio to the model's legs scales the whole body.
  const double mean = leg_length(model.body.skeleton);
  const auto legs = legs_by_kinect(layout.joints, out.input.kinect);
  out.is_sized = legs.has_value() && mean > 0.0;
  out.body = scaled(model.body.skeleton, out.is_sized ? *legs / mean : 1.0);
  return out;
}

nlohmann::ordered_json about_fused(const FuseModel& model, const FusedInput& given) {
  const PoseLayout& layout = model.layout.nodes;
  const auto& seen = given.input.kinect.seen;
  nlohmann::ordered_json out{{"kinect", given.kinect},
                             {"imu", given.nodes.stream},
                             {"frames", given.input.frames()},
                             {"rate_hz", layout.rate_hz},
                             {"joints", model.body.skeleton.joints()},
                             {"method", model.facts.method},
                             {"missing", share_of(seen, 0)},
                             {"inferred", share_of(seen, 1)}};
  // about_nodes() adds the members of the nodes. They include "warnings", which the next line
  // extends.
  out.update(about_nodes(layout, given.posed, given.input.nodes, given.nodes));
  for (const std::string& warning : given.warnings) out["warnings"].push_back(warning);
  return out;
}

}  // namespace kinalign
