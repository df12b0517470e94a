// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/fuse/fuse_draws.h"

#include "kinalign/models/fuse/seen_bones.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

/// Lanes of the random stream, one for each decision. Each decision has its own lane, so it does
/// not change if another decision is left out.
enum Lane : std::uint64_t {
  lane_heading,
  lane_device,
  lane_part,
  lane_kind,
  lane_which,
  lane_begin,
  lane_length
};

/// Sets a limb of the Kinect or one node to missing, for a random time.
void lose_a_part(FuseInput& input, const FuseLayout& layout, const FuseDraws& draws,
                 const RandomStream& random) {
  const double frames = static_cast<double>(input.frames());
  const double length =
      layout.nodes.rate_hz * (draws.least_lost_s + random.uniform(0, lane_length) *
                                                       (draws.most_lost_s - draws.least_lost_s));
  // If a loss would reach beyond the end of the crop, it is shortened.
  const auto begin = static_cast<std::size_t>(random.uniform(0, lane_begin) * frames);
  const auto end = std::min(input.frames(), begin + static_cast<std::size_t>(std::lround(length)));
  const auto one_of = [&](std::size_t count) {
    const double which = random.uniform(0, lane_which) * static_cast<double>(count);
    return std::min(static_cast<std::size_t>(which), count - 1);
  };
  if (random.uniform(0, lane_kind) < draws.lost_limb) {
    lose_limb(input.kinect, layout.joints, one_of(kinect_limb_joints.size()), begin, end);
    return;
  }
  const std::size_t nodes = input.nodes.nodes, node = one_of(nodes);
  for (std::size_t t = begin; t < end; ++t) input.nodes.valid[t * nodes + node] = 0;
}

}  // namespace

void lose_limb(JointFrames& kinect, const std::vector<std::string>& names, std::size_t limb,
               std::size_t begin, std::size_t end) {
  const auto& lost = kinect_limb_joints[limb].joints;
  for (std::size_t j = 0; j < names.size(); ++j) {
    if (std::find(lost.begin(), lost.end(), names[j]) == lost.end()) continue;
    for (std::size_t t = begin; t < std::min(end, kinect.frames()); ++t) {
      kinect.seen[t * kinect.joints + j] = 0;
    }
  }
}

void lose_kinect(JointFrames& kinect) { std::fill(kinect.seen.begin(), kinect.seen.end(), 0); }

void lose_nodes(NodeFrames& nodes) { std::fill(nodes.valid.begin(), nodes.valid.end(), 0); }

// The order matters: errors first, then losses, then the step that is also done when a model is
// used.
FuseInput drawn_input(FuseInput input, const FuseLayout& layout, const FuseDraws& draws,
                      std::uint64_t seed, std::uint64_t number) {
  // Each crop has two random streams, one for choices and one for errors of nodes.
  const RandomStream random(seed, 2 * number), of_errors(seed, 2 * number + 1);
  NodeErrors errors = draws.errors;
  if (random.uniform(0, lane_heading) < draws.unknown_heading) errors.yaw_deg = draws.unknown_deg;
  input.nodes = with_errors(std::move(input.nodes), errors, of_errors);
  if (draws.devices == Devices::kinect) lose_nodes(input.nodes);
  if (draws.devices == Devices::nodes) lose_kinect(input.kinect);
  // One random number decides about both devices, so that both are never missing together.
  if (draws.devices == Devices::both) {
    const double device = random.uniform(0, lane_device);
    if (device < draws.without_kinect) {
      lose_kinect(input.kinect);
    } else if (device < draws.without_kinect + draws.without_nodes) {
      lose_nodes(input.nodes);
    }
  }
  if (random.uniform(0, lane_part) < draws.lost_part) lose_a_part(input, layout, draws, random);
  unexchange(layout, input);  // the same step as when a model is used
  return input;
}

}  // namespace kinalign
