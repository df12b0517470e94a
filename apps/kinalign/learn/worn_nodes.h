// SPDX-License-Identifier: Apache-2.0
// The nodes of a stream in the form that a model needs: chosen by name, on its grid, calibrated by
// a T-pose. Also the text and JSON about them. Used by pose and fuse.
#pragma once

#include "apps/kinalign/learn/node_source.h"

#include "kinalign/models/pose/live_worn.h"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace kinalign {

/// The words of --tpose ("START,END", empty: find it) and --heading (auto, shared, mounting).
struct WornWords {
  std::string t_pose, headings = "auto";
};

/// The flags tpose and heading.
std::vector<Field> worn_flags(WornWords& o);
/// Fails if --tpose states no interval of seconds.
Result<void> check(const WornWords& o);
/// The same options for a live run. Also fails if the T-pose lies beyond the time that a live run
/// waits for it.
Result<LiveWornOptions> live_options(const WornWords& o);

/// [N] the stream's index of each of the model's nodes; absent if the stream lacks it.
using NodeChoice = std::vector<std::optional<std::size_t>>;

/// Fails without the root's node and two others that have samples.
Result<NodeChoice> choose(const PoseLayout& layout, const NamedNodes& nodes);

/// The frames of the T-pose.
struct ChosenTPose {
  TPose frames;
  bool found = false;  // true: found by the program, not stated in --tpose
};

/// The nodes on the model's grid, calibrated.
/// The result of calibrated_nodes(). `even` has one row for each frame of the grid; on_bones()
/// applies `calibration` to it.
struct PosedNodes {
  NodeChoice choice;
  EvenNodes even;
  ChosenTPose t_pose;
  NodeCalibration calibration;
  std::vector<std::string> warnings{};  // about how the nodes are worn together, and of the file's
                                        // reader
};

/// `span`: the grid; absent: the one of the root's samples. Fails like choose(), too.
Result<PosedNodes> calibrated_nodes(const PoseLayout& layout, const Skeleton& body,
                                    NamedNodes nodes, const WornWords& o,
                                    std::optional<EvenSpan> span = std::nullopt);

/// The members valid, nodes, t_pose, headings and so on, and warnings. `nodes`: after calibration.
nlohmann::ordered_json about_nodes(const PoseLayout& layout, const PosedNodes& posed,
                                   const NodeFrames& nodes, const NamedNodes& named);

/// The printed lines nodes, T-pose and heading.
std::string node_lines(const nlohmann::ordered_json& about);

}  // namespace kinalign
