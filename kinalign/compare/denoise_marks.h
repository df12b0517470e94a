// SPDX-License-Identifier: Apache-2.0
// The marks of a cleaned skeleton, on the joints that Kinect and truth share: 18 of UI-PRMD, 16 of
// a suit, whose skeleton has no tips of the feet.
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

/// Parts of the body whose stated radii are judged separately. Shoulders and hips belong to the
/// trunk.
inline constexpr std::array<std::string_view, 3> radius_groups{"trunk", "arms", "legs"};

/// The marks of one stretch of a take.
struct DenoiseMarks {
  ProtocolMarks protocol;
  TableNine table_nine;           // positions in cm, in the answer's own space
  std::optional<double> hand_cm;  // mean distance of both wrists
  std::array<std::optional<double>, shared_joint_count> joint_cm{};  // one for each joint
  std::optional<double> lag_ms;     // delay of the answer's speeds against the truth's
  std::optional<double> amplitude;  // motion about the root, divided by the truth's
  FeetMarks feet;                   // ankles and toes; contacts are the truth's
  /// The stated 90 % radius, by radius_groups; without cells if none is stated.
  std::array<RadiusMarks, radius_groups.size()> radii{};
};

/// The origin of positions.
enum class MarkedIn : std::uint8_t {
  space,     // the truth's space
  own_root,  // each skeleton's own root and heading, as in BRA's published marks (own_root())
};

/// Marks many answers of one layout. A marker is made once for all pairs of a data set and does not
/// change afterwards. It keeps the limb lengths of every person and action, because a stretch is
/// judged by the lengths of the whole take.
class DenoiseMarker {
 public:
  /// Fails if the outputs have fewer than 12 of the 18 shared joints: a pose can't be fitted then.
  static Result<DenoiseMarker> make(const DenoiseLayout& layout, const std::vector<Pair>& pairs,
                                    MarkedIn marked_in = MarkedIn::space);

  /// `answer`: [T,Jout,3] m; `spread`: [T,Jout] m per axis, or empty. `pair` must be of a person
  /// and an action that were among the pairs of make().
  DenoiseMarks marks_of(const Pair& pair, const std::vector<float>& answer,
                        const std::vector<float>& spread) const;

 private:
  /// Index in the outputs; absent: not marked.
  std::array<std::optional<std::size_t>, shared_joint_count> places_;
  std::vector<std::size_t> there_;  // the shared joints that are marked
  std::vector<Bone> bones_;         // limbs between them, by indices in there_
  MarkedIn marked_in_ = MarkedIn::space;
  std::size_t joints_ = 0;
  double rate_hz_ = 0.0;
  /// The median true lengths of the limb bones, m, by person and action.
  std::map<std::string, std::vector<std::optional<double>>> lengths_;
};

}  // namespace kinalign
