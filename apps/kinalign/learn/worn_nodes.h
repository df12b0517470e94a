// SPDX-License-Identifier: Apache-2.0
// Prepares the nodes of a stream for a model: chosen by name, at the model's frame rate, calibrated
// with a T-pose. Also makes the text and JSON about them. `pose` and `fuse` use it.
#pragma once

#include "apps/kinalign/learn/node_source.h"

#include "kinalign/models/pose/live_worn.h"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// The values of --tpose ("START,END"; empty: find the T-pose) and --heading (auto, shared,
/// mounting).
struct WornWords {
  std::string t_pose, headings = "auto";
};

/// The flags --tpose and --heading.
std::vector<Field> worn_flags(WornWords& o);
/// Fails if --tpose is not an interval of seconds.
Result<void> check(const WornWords& o);
/// The same options for a live run. Also fails if the T-pose is later than a live run waits for it.
Result<LiveWornOptions> live_options(const WornWords& o);

/// For each node of the model its index in the stream; empty if the stream lacks the node.
using NodeChoice = std::vector<std::optional<std::size_t>>;

/// Finds the nodes of the model. Fails if the root's node or two of the others have no samples.
Result<NodeChoice> choose(const PoseLayout& layout, const NamedNodes& nodes);

/// The frames of a T-pose.
struct ChosenTPose {
  TPose frames;
  bool found = false;  // true: the program found it; false: --tpose stated it
};

/// The nodes at the model's frame rate and their calibration. `even` has one row for each frame;
/// on_bones() applies `calibration` to it.
struct PosedNodes {
  NodeChoice choice;
  EvenNodes even;
  ChosenTPose t_pose;
  NodeCalibration calibration;
  std::vector<std::string> warnings{};  // about how the nodes are worn, and from the file's reader
};

/// Makes PosedNodes. `span`: the time of the frames; empty: the time of the root's samples. Fails
/// also like choose().
Result<PosedNodes> calibrated_nodes(const PoseLayout& layout, const Skeleton& body,
                                    NamedNodes nodes, const WornWords& o,
                                    std::optional<EvenSpan> span = std::nullopt);

/// The JSON members valid, nodes, t_pose, headings, warnings and others. `nodes`: after
/// calibration.
nlohmann::ordered_json about_nodes(const PoseLayout& layout, const PosedNodes& posed,
                                   const NodeFrames& nodes, const NamedNodes& named);

/// The printed lines about nodes, T-pose and heading.
std::string node_lines(const nlohmann::ordered_json& about);

}  // namespace kinalign
