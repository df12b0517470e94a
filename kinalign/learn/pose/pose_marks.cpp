// SPDX-License-Identifier: Apache-2.0
#include "kinalign/learn/pose/pose_marks.h"

#include "kinalign/learn/pose/node_errors.h"

#include <utility>

namespace kinalign {

namespace {

// The seed is fixed, so that every model gets the same errors.
constexpr std::uint64_t marks_seed = 5;
constexpr double later_minutes = 20.0;

struct MarkedState {
  std::string name;
  NodeErrors errors;
  bool is_one_lost = false;
};

std::vector<MarkedState> marked_states(const std::string& lost) {
  // The default errors are those that a calibration leaves. Lost nodes are measured separately.
  NodeErrors calibrated;
  calibrated.lost_share = 0.0;
  NodeErrors later = calibrated;
  later.drift_deg = drift_after(later_minutes);
  return {{"clean", no_node_errors()},
          {"calibrated", calibrated},
          {"20 minutes later", later},
          {lost + " lost", calibrated, true}};
}

}  // namespace

Result<std::vector<PoseMark>> pose_marks(PoseSolver& solver, const PoseData& data,
                                         std::size_t lost) {
  const PoseLayout& layout = solver.model().layout;
  if (layout.nodes != data.nodes || layout.bones != data.body.bones) {
    return Failure(
        Error{"", 0, "a model of the data's nodes and bones", "a model of other nodes or bones"});
  }
  if (data.tested.empty()) return Failure(Error{"", 0, "people of a test part", "none"});
  std::vector<PoseMark> out;
  for (const MarkedState& state : marked_states(layout.nodes[lost])) {
    PoseMark mark;
    mark.nodes = state.name;
    for (std::size_t i = 0; i < data.tested.size(); ++i) {
      const PoseSequence& one = data.tested[i];
      NodeFrames nodes = with_errors(one.nodes, state.errors, RandomStream(marks_seed, i));
      if (state.is_one_lost) nodes = without_node(std::move(nodes), lost);
      // The bone lengths are the person's and not the model's, so only rotations are compared.
      const TruePose truth{one.rotations, one.rest_offsets};
      auto rotations = solver.answer(nodes).rotations;
      mark.answer.add(pose_errors(data.body, rotations, truth, layout.rate_hz));
      smooth_turns(layout.bones.size(), rotations);
      const PoseErrors smoothed = pose_errors(data.body, rotations, truth, layout.rate_hz);
      mark.smoothed.add(smoothed);
      mark.people[one.subject].add(smoothed);
    }
    out.push_back(std::move(mark));
  }
  return out;
}

}  // namespace kinalign
