// SPDX-License-Identifier: Apache-2.0
// Prepares the nodes of a live stream for a model: finds their names, reports about the T-pose, and
// makes the JSON at the end. `pose --live` and `fuse --live` use it.
#pragma once

#include "apps/kinalign/live/live_node_names.h"
#include "apps/kinalign/live/live_session.h"

#include "kinalign/models/pose/live_worn.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace kinalign {

// The next four declarations also serve runs on files (apps/kinalign/learn/worn_nodes.h).

/// The time of a T-pose, s, and the fastest turn of a node during it, degrees/s.
struct UsedTPose {
  double from_s = 0.0, to_s = 0.0;
  bool found = false;  // true: the program found it; false: the user stated it
  double fastest_deg_s = 0.0;
};
/// The JSON members t_pose, headings, facing, spread_deg and worn_as_described.
nlohmann::ordered_json calibration_json(const UsedTPose& t_pose, const NodeCalibration& found);
/// Appends a warning if a node turned during the T-pose, because the calibration of all nodes is
/// wrong then.
void warn_of_turn(double fastest_deg_s, nlohmann::ordered_json& warnings);
/// The warning about a node that is missing for 2 s or longer, or always. Empty if the node is not
/// missing for so long. `is_used`: the node has samples in the T-pose.
std::string missing_warning(const std::string& node, bool has_samples, bool is_used, double lost_s);

/// Adds names and messages to LiveWorn, which makes the frames and the calibration. Invariant: each
/// change (T-pose, loss, return of a node) is reported once.
class LiveWornReport {
 public:
  /// All arguments must live longer than this object. `stream`: the stream of the nodes; empty: the
  /// first that sends samples of nodes.
  LiveWornReport(const PoseLayout& layout, const std::string& stream, LiveWorn& worn,
                 LiveSession& session);

  /// The instruction for the person who wears the nodes: how to hold the T-pose.
  static std::string instruction();

  /// Passes a sample to LiveWorn if it comes from a node of the model. Returns true if so.
  Result<bool> add(const LiveNodeSample& sample);
  /// Handles a mark. A mark of a T-pose calibrates the nodes.
  void take(const LiveMark& mark);
  /// Reports the T-poses that were accepted or refused since the last call. Returns true if one was
  /// accepted.
  bool report_t_pose();
  /// Called for each answered frame; `valid` says for each node whether it had a sample. Tells the
  /// people in the room that a node has been missing for long, and that it sends again.
  void watch(const std::vector<std::uint8_t>& valid);
  /// Counts the valid nodes of one frame, for the summary at the end.
  void count(const std::vector<std::uint8_t>& valid);

  /// A text that says what the run waits for. Empty once the nodes are calibrated.
  std::string waits_for() const;
  const LiveNodeNames& names() const { return names_; }
  /// The JSON members that about_nodes() makes in a run on a file. The nodes must be calibrated.
  nlohmann::ordered_json about() const;

 private:
  /// The number of frames in which a node was valid, and its longest loss in frames.
  struct Presence {
    std::size_t valid = 0, lost = 0, longest = 0;  // `lost`: frames since the node was last valid
  };
  void report_refusal(const std::string& why);
  nlohmann::ordered_json calibration() const;

  const PoseLayout* layout_;
  LiveWorn* worn_;
  LiveSession* session_;
  LiveNodeNames names_;
  std::vector<Presence> presence_;    // for each node
  std::vector<std::size_t> missing_;  // for each node: frames since it was last valid
  std::size_t frames_ = 0;
  std::string refusal_;                  // the refusal that was reported last
  std::optional<std::size_t> reported_;  // the first frame of the T-pose that was reported last
};

}  // namespace kinalign
