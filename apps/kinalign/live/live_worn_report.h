// SPDX-License-Identifier: Apache-2.0
// The nodes of a live stream on their way into a model: their names, the reports about the T-pose,
// and the JSON at the end. Used by pose --live and fuse --live.
#pragma once

#include "apps/kinalign/live/live_node_names.h"
#include "apps/kinalign/live/live_session.h"

#include "kinalign/models/pose/live_worn.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace kinalign {

// The next three are about nodes of files as well (apps/kinalign/learn/worn_nodes.h).

/// The seconds of a T-pose, and the fastest turn of a node in it.
struct UsedTPose {
  double from_s = 0.0, to_s = 0.0;
  bool found = false;  // true: found by the program, not stated by the user
  double fastest_deg_s = 0.0;
};
/// The members t_pose, headings, facing, spread_deg and worn_as_described.
nlohmann::ordered_json calibration_json(const UsedTPose& t_pose, const NodeCalibration& found);
/// Appends a warning if a node turned in the T-pose, which makes the calibration of all nodes
/// wrong.
void warn_of_turn(double fastest_deg_s, nlohmann::ordered_json& warnings);
/// The warning about a node that is missing for 2 s or longer, or always; empty if it is not.
/// `is_used`: it has samples in the T-pose.
std::string missing_warning(const std::string& node, bool has_samples, bool is_used, double lost_s);

/// The grid and the calibration are LiveWorn's; this class adds names and words. Invariant: each
/// change (T-pose, loss, return) is reported once.
class LiveWornReport {
 public:
  /// All arguments must live longer. `stream`: the stream of the nodes; empty: the first that sends
  /// any.
  LiveWornReport(const PoseLayout& layout, const std::string& stream, LiveWorn& worn,
                 LiveSession& session);

  /// The instruction for the person: how to hold the T-pose.
  static std::string instruction();

  /// Puts the sample onto the grid if its node is one of the model's. Returns whether it is.
  Result<bool> add(const LiveNodeSample& sample);
  /// Handles a mark. A mark of a T-pose calibrates the nodes.
  void take(const LiveMark& mark);
  /// Reports T-poses taken or refused since the last call. True if one was taken.
  bool report_t_pose();
  /// Called for each answered frame, with the validity of the nodes [N]. Reports a node that is
  /// missing for long, and its return.
  /// It tells a person in the room what to do while the run lasts; count() is for the summary.
  void watch(const std::vector<std::uint8_t>& valid);
  /// Counts a frame of the result.
  void count(const std::vector<std::uint8_t>& valid);

  /// The thing that is waited for; empty: the nodes are calibrated.
  std::string waits_for() const;
  const LiveNodeNames& names() const { return names_; }
  /// The members that about_nodes() has for a file. Needs calibrated nodes.
  nlohmann::ordered_json about() const;

 private:
  /// The frames in which a node was valid, and its longest loss.
  /// The unit is a frame of the result.
  struct Presence {
    std::size_t valid = 0, lost = 0, longest = 0;  // frames; lost: until now
  };
  void report_refusal(const std::string& why);
  nlohmann::ordered_json calibration() const;

  const PoseLayout* layout_;
  LiveWorn* worn_;
  LiveSession* session_;
  LiveNodeNames names_;
  std::vector<Presence> presence_;    // [N]
  std::vector<std::size_t> missing_;  // [N] frames answered without the node, until now
  std::size_t frames_ = 0;
  std::string refusal_;                  // the last reported refusal
  std::optional<std::size_t> reported_;  // the first frame of the reported T-pose
};

}  // namespace kinalign
