// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/live/live_node_names.h"

#include "kinalign/models/pose/node_places.h"

#include <fmt/format.h>

#include <utility>

namespace kinalign {

LiveNodeNames::LiveNodeNames(const PoseLayout& layout, std::string stream)
    : names_(layout.nodes),
      stream_(std::move(stream), "one stream of inertial nodes (its stream by name)"),
      called_(layout.nodes.size()) {}

/// Each node's result is stored, so that a name is looked up once. If two nodes state the same
/// place, the first one keeps it.
Result<std::optional<std::size_t>> LiveNodeNames::find(const RawChannel& node) {
  const auto known = found_.find(&node);
  if (known != found_.end()) return known->second;
  // The result is stored before the checks, so that a node that is not used is not looked up again.
  std::optional<std::size_t>& found = found_[&node];
  if (!KA_TRY(stream_.takes(node.stream))) return found;
  // lab.toml states the node's place. A node without a place is called by its id.
  const std::string& name = node.place.empty() ? node.node : node.place;
  for (std::size_t n = 0; n < names_.size() && !found; ++n) {
    // place_called() also knows other words for a place.
    const bool is = name == names_[n] || place_called(name) == names_[n];
    if (is && called_[n].empty()) found = n;
  }
  if (found) {
    called_[*found] = name;
  } else {
    others_.push_back(node.stream + " " + name);
  }
  return found;
}

std::string LiveNodeNames::text() const {
  std::string lacks;
  std::size_t there = 0;
  for (std::size_t n = 0; n < names_.size(); ++n) {
    if (called_[n].empty()) lacks += (lacks.empty() ? "" : ", ") + names_[n];
    there += called_[n].empty() ? 0 : 1;
  }
  std::string out = fmt::format("{} of {} nodes", there, names_.size());
  return lacks.empty() ? out : out + "; not yet: " + lacks;
}

}  // namespace kinalign
