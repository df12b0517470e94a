// SPDX-License-Identifier: Apache-2.0
// Which nodes of a live stream are those of a model.
#pragma once

#include "kinalign/models/pose/pose_features.h"
#include "kinalign/recording/format.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace kinalign {

class LiveNodeNames {
 public:
  /// `stream`: whose nodes; empty: the first stream that sends any.
  LiveNodeNames(const PoseLayout& layout, std::string stream);

  /// The layout's node that this one is, by its place or id; absent: none, or another one has the
  /// place already. Fails where no stream was chosen and a second one sends nodes.
  Result<std::optional<std::size_t>> find(const RawChannel& node);

  const std::string& stream() const { return stream_; }
  /// [N] the stream's name for each; empty: it has not come.
  const std::vector<std::string>& called() const { return called_; }
  /// "4 of 5 nodes, ankle_left has not come".
  std::string text() const;
  /// Nodes that are none of the model's: "imu 7".
  const std::vector<std::string>& others() const { return others_; }

 private:
  std::vector<std::string> names_;  // [N] of the layout
  std::string stream_;
  bool is_chosen_;
  std::vector<std::string> called_, others_;
  std::map<const RawChannel*, std::optional<std::size_t>> found_;
};

}  // namespace kinalign
