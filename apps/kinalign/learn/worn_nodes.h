// SPDX-License-Identifier: Apache-2.0
// Nodes of a stream as a model wants them: chosen by name, on its grid, calibrated by a T-pose, and
// what is to be said of them. What pose and fuse share.
#pragma once

#include "apps/kinalign/learn/node_source.h"

#include "kinalign/models/pose/live_worn.h"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace kinalign {

struct WornWords {
  std::string t_pose, headings = "auto";
};

/// The flags tpose and heading.
std::vector<Field> worn_flags(WornWords& o);
/// Fails where the T-pose's seconds are none.
Result<void> check(const WornWords& o);
/// The same for a live run. Fails where the T-pose lies too late for it, too.
Result<LiveWornOptions> live_options(const WornWords& o);

/// The model's nodes in a stream: [N] which of the stream's, absent where it has none.
using NodeChoice = std::vector<std::optional<std::size_t>>;

/// Fails without the root and two others.
Result<NodeChoice> choose(const PoseLayout& layout, const NamedNodes& nodes);

/// What the T-pose was taken from.
struct ChosenTPose {
  TPose frames;
  double from_s = 0.0, to_s = 0.0;
  bool found = false;  // by itself
};

/// The nodes on the model's grid, calibrated.
struct PosedNodes {
  NodeChoice choice;
  EvenNodes even;
  ChosenTPose t_pose;
  NodeCalibration calibration;
  std::vector<std::string> warnings{};  // of how all of them are worn
};

/// `span`: the grid, in place of the root's. Fails as choose() does, too.
Result<PosedNodes> calibrated_nodes(const PoseLayout& layout, const Skeleton& body,
                                    NamedNodes nodes, const WornWords& o,
                                    std::optional<EvenSpan> span = std::nullopt);

/// The members valid, nodes, t_pose, headings and so on, and warnings. `nodes`: calibrated.
nlohmann::ordered_json about_nodes(const PoseLayout& layout, const PosedNodes& posed,
                                   const NodeFrames& nodes, const NamedNodes& named);

/// The lines nodes, T-pose and heading.
std::string node_lines(const nlohmann::ordered_json& about);

}  // namespace kinalign
