// SPDX-License-Identifier: Apache-2.0
// Nodes of a live stream on their way into a model: which is which, what is told of the T-pose, and
// what is to be said of them at the end. What pose --live and fuse --live share.
#pragma once

#include "apps/kinalign/live/live_node_names.h"
#include "apps/kinalign/live/live_session.h"

#include "kinalign/models/pose/live_worn.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace kinalign {

class LiveWornReport {
 public:
  /// All must live longer. `stream`: whose nodes; empty: the first stream that sends any.
  LiveWornReport(const PoseLayout& layout, const std::string& stream, LiveWorn& worn,
                 LiveSession& session);

  /// What the person has to do now.
  static std::string wish();

  /// Puts the sample onto the grid, if it is of one of the model's nodes; whether it is.
  Result<bool> add(const LiveNodeSample& sample);
  /// A mark of a T-pose calibrates the nodes.
  void take(const LiveMark& mark);
  /// Tells of a T-pose that was taken or refused since this was asked last. Whether one was taken.
  bool tell_t_pose();
  /// A frame was answered: which nodes were valid in it [N]. Tells of a node that is missing for
  /// long, and of its return.
  void watch(const std::vector<std::uint8_t>& valid);
  /// A frame of the result.
  void count(const std::vector<std::uint8_t>& valid);

  /// What is waited for; empty: the nodes are calibrated.
  std::string waits_for() const;
  const LiveNodeNames& names() const { return names_; }
  /// The members that about_nodes() has of a file. Calibrated nodes only.
  nlohmann::ordered_json about() const;

 private:
  /// How often a node was valid, and its longest loss.
  struct Presence {
    std::size_t valid = 0, lost = 0, longest = 0;  // frames; lost: up to now
  };
  void tell_refusal(const std::string& why);
  nlohmann::ordered_json calibration() const;
  std::string warning_of(std::size_t node) const;

  const PoseLayout* layout_;
  LiveWorn* worn_;
  LiveSession* session_;
  LiveNodeNames names_;
  std::vector<Presence> presence_;    // [N]
  std::vector<std::size_t> missing_;  // [N] frames that were answered without the node up to now
  std::size_t frames_ = 0;
  std::string refusal_;              // told last
  std::optional<std::size_t> told_;  // the first frame of the T-pose that was
};

}  // namespace kinalign
