// SPDX-License-Identifier: Apache-2.0
// The error measures ("marks") of the answer of a method, which is a cleaned Kinect skeleton. They
// use the joints that Kinect and truth have in common: 18 for UI-PRMD and 16 for a motion capture
// suit, whose skeleton has no toe tips.
#pragma once

#include "kinalign/evaluate/feet.h"
#include "kinalign/evaluate/protocol.h"
#include "kinalign/evaluate/table_nine.h"
#include "kinalign/evaluate/uncertainty.h"
#include "kinalign/models/denoise_model.h"
#include "kinalign/models/pairs.h"
#include "kinalign/motion/shared_joints.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// Parts of the body whose stated error radii are judged separately. Shoulders and hips are part of
/// the trunk.
inline constexpr std::array<std::string_view, 3> radius_groups{"trunk", "arms", "legs"};

/// The error measures of one part of a take.
struct DenoiseMarks {
  ProtocolMarks protocol;
  TableNine table_nine;           // table 9 of the HFUT-MMD paper, from positions in cm
  std::optional<double> hand_cm;  // mean position error of both wrists
  std::array<std::optional<double>, shared_joint_count> joint_cm{};  // one for each joint
  std::optional<double> lag_ms;     // delay of the method's speeds relative to the true speeds
  std::optional<double> amplitude;  // motion about the root, divided by the true motion
  FeetMarks feet;                   // ankles and toes; contacts with the floor come from the truth
  /// The stated 90 % radius for each of radius_groups; without values if the method states none.
  std::array<RadiusMarks, radius_groups.size()> radii{};
};

/// The origin of the positions.
enum class MarkedIn : std::uint8_t {
  space,     // the truth's space
  own_root,  // each skeleton's own root and heading, as in BRA's published figures (own_root())
};

/// Computes the error measures of many answers of one layout. One object is made for all pairs
/// (Kinect input and truth) of a data set and does not change later. It stores the limb lengths of
/// every person and action, because a part of a take is judged by the lengths of the whole take.
class DenoiseMarker {
 public:
  /// Fails if the outputs have fewer than 12 of the 18 shared joints, because a pose can't be
  /// fitted then.
  static Result<DenoiseMarker> make(const DenoiseLayout& layout, const std::vector<Pair>& pairs,
                                    MarkedIn marked_in = MarkedIn::space);

  /// `answer`: the cleaned joints [T,Jout,3] m; `spread`: [T,Jout] m per axis, or empty. The person
  /// and the action of `pair` must be among the pairs of make().
  DenoiseMarks marks_of(const Pair& pair, const std::vector<float>& answer,
                        const std::vector<float>& spread) const;

 private:
  /// Index of the shared joint in the outputs; absent: the joint is not judged.
  std::array<std::optional<std::size_t>, shared_joint_count> places_;
  std::vector<std::size_t> there_;  // the shared joints that are judged
  std::vector<Bone> bones_;         // limb bones between them, as indices in there_
  MarkedIn marked_in_ = MarkedIn::space;
  std::size_t joints_ = 0;
  double rate_hz_ = 0.0;
  /// Median true lengths of the limb bones, m, by person and action.
  std::map<std::string, std::vector<std::optional<double>>> lengths_;
};

}  // namespace kinalign
