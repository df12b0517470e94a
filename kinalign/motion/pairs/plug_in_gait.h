// SPDX-License-Identifier: Apache-2.0
// The 18 shared joints from the 39 markers of Vicon's Plug-in-Gait, as UI-PRMD's protocol has them:
// hips by Harrington et al., J. Biomech. 40 (2007); knee and ankle by Plug-in-Gait's chord; elbow
// and knee moved so that forearm and shank keep their length.
#pragma once

#include "kinalign/motion/shared_joints.h"

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace kinalign {

inline constexpr std::array<std::string_view, 39> plug_in_gait_markers{
    "LFHD", "RFHD", "LBHD", "RBHD", "C7",   "T10",  "CLAV", "STRN", "RBAK", "LSHO",
    "LUPA", "LELB", "LFRM", "LWRA", "LWRB", "LFIN", "RSHO", "RUPA", "RELB", "RFRM",
    "RWRA", "RWRB", "RFIN", "LASI", "RASI", "LPSI", "RPSI", "LTHI", "LKNE", "LTIB",
    "LANK", "LHEE", "LTOE", "RTHI", "RKNE", "RTIB", "RANK", "RHEE", "RTOE"};

/// F frames of all markers of one person, in the order of plug_in_gait_markers.
struct MarkerFrames {
  std::span<const double> positions;   // [F,39,3] m; a marker that was not seen holds zeros
  std::span<const std::uint8_t> seen;  // [F,39]

  std::size_t frames() const { return seen.size() / plug_in_gait_markers.size(); }
};

/// The distance of joints from the places that the markers alone give. Markers sit 1 to 5 cm above
/// a joint.
struct SideShift {
  double elbow_m = 0.0;         // along forearm to shoulder
  double knee_along_m = 0.0;    // along the thigh to the hip
  double knee_forward_m = 0.0;  // at a right angle to thigh and knee marker, to the front
};
struct FunctionalShifts {
  SideShift left, right;
};

/// The shifts of one person with which forearms and shanks vary least in length. 0 where a limb was
/// never seen as a whole. Every fifth frame is enough.
FunctionalShifts functional_shifts(const MarkerFrames& markers);

/// F frames of the 18 shared joints.
struct JointCentres {
  std::vector<double> positions;    // [F,18,3] m
  std::vector<std::uint8_t> valid;  // [F,18] all markers that the joint needs were seen

  std::size_t frames() const { return valid.size() / shared_joint_count; }
};

/// The frames should be all that there are of a person: the size of the pelvis is their median.
JointCentres joint_centres(const MarkerFrames& markers, const FunctionalShifts& shifts);

/// Puts joints that are not valid on the line between the valid frames around, so that a spline can
/// run through them. They stay marked.
void fill_invalid(JointCentres& joints);

}  // namespace kinalign
