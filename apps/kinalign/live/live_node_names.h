// SPDX-License-Identifier: Apache-2.0
// Assigns the nodes of a live stream to the nodes of a model.
#pragma once

#include "kinalign/models/pose/pose_features.h"
#include "kinalign/recording/format.h"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kinalign {

/// The stream of a device: the chosen one, else the first that sends.
class LiveChoice {
 public:
  /// `name`: empty if none was chosen. `expected`: for the error.
  LiveChoice(std::string name, std::string expected)
      : name_(std::move(name)), expected_(std::move(expected)), is_chosen_(!name_.empty()) {}

  /// True if data of that stream are used. Fails if a second stream sends and none was chosen: two
  /// streams could be two people.
  Result<bool> takes(const std::string& sends) {
    if (name_.empty()) name_ = sends;
    if (is_chosen_ || sends == name_) return sends == name_;
    return Failure(Error{"--live", 0, expected_, shown(name_) + ", " + shown(sends)});
  }
  const std::string& name() const { return name_; }

 private:
  std::string name_, expected_;
  bool is_chosen_;
};

/// Invariant: once a node of the layout has a sender, it keeps this sender until the end of the
/// run.
class LiveNodeNames {
 public:
  /// `stream`: the stream of the nodes; empty: the first stream that sends any.
  LiveNodeNames(const PoseLayout& layout, std::string stream);

  /// The layout's node that this one is, by its place or id. Absent if the layout has no such node,
  /// or another node has the place already. Fails if no stream was chosen and a second stream sends
  /// nodes.
  Result<std::optional<std::size_t>> find(const RawChannel& node);

  const std::string& stream() const { return stream_.name(); }
  /// [N] the stream's name for each node; empty: nothing came from it yet.
  const std::vector<std::string>& called() const { return called_; }
  /// "4 of 5 nodes; not yet: ankle_left".
  std::string text() const;
  /// The nodes that the model does not use: "imu 7".
  const std::vector<std::string>& others() const { return others_; }

 private:
  std::vector<std::string> names_;  // [N] the layout's names
  LiveChoice stream_;
  std::vector<std::string> called_, others_;
  // The key is the channel's address, which is valid as long as the stream object.
  std::map<const RawChannel*, std::optional<std::size_t>> found_;
};

}  // namespace kinalign
