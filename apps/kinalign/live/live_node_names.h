// SPDX-License-Identifier: Apache-2.0
// Finds for each node of a live stream the node of the model that it stands for.
#pragma once

#include "kinalign/models/pose/pose_features.h"
#include "kinalign/recording/format.h"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kinalign {

/// The stream that is used: the one that the user chose, else the first that sends.
class LiveChoice {
 public:
  /// `name`: the chosen stream; empty if the user chose none. `expected`: a text for the error.
  LiveChoice(std::string name, std::string expected)
      : name_(std::move(name)), expected_(std::move(expected)), is_chosen_(!name_.empty()) {}

  /// True if data of the stream `sends` is used. Fails if a second stream sends and the user chose
  /// none: the two streams could show two people.
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

/// Assigns the nodes of a stream to the nodes of a model. Invariant: a node of the model keeps its
/// first sender until the end of the run.
class LiveNodeNames {
 public:
  /// `stream`: the stream of the nodes; empty: the first stream that sends samples of nodes.
  LiveNodeNames(const PoseLayout& layout, std::string stream);

  /// The index of the model's node with this node's place or id. Empty if the model has no such
  /// node, or if another sender has the place. Fails if a second stream sends nodes and the user
  /// chose none.
  Result<std::optional<std::size_t>> find(const RawChannel& node);

  const std::string& stream() const { return stream_.name(); }
  /// For each node of the model its name in the stream; empty if no sample of it has come yet.
  const std::vector<std::string>& called() const { return called_; }
  /// The state in words: "4 of 5 nodes; not yet: ankle_left".
  std::string text() const;
  /// The nodes in the stream that the model does not use: "imu 7".
  const std::vector<std::string>& others() const { return others_; }

 private:
  std::vector<std::string> names_;  // the names of the model's nodes
  LiveChoice stream_;
  std::vector<std::string> called_, others_;
  // The key is the address of the channel. It stays valid as long as the stream object lives.
  std::map<const RawChannel*, std::optional<std::size_t>> found_;
};

}  // namespace kinalign
