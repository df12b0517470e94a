// SPDX-License-Identifier: Apache-2.0
// Computes the 18 shared joints from the 39 markers of Vicon's Plug-in-Gait, as in UI-PRMD's
// protocol: hips by Harrington et al., J. Biomech. 40 (2007); knee and ankle by Plug-in-Gait's
// chord function; elbow and knee shifted so that forearm and shank keep their lengths.
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
/// The arrays belong to the caller.
struct MarkerFrames {
  std::span<const double> positions;   // [F,39,3] m; a marker that is not seen holds zeros
  std::span<const std::uint8_t> seen;  // [F,39] 0: the marker was not seen

  std::size_t frames() const { return seen.size() / plug_in_gait_markers.size(); }
};

/// The offset of joints from the places that are computed from the markers alone, because markers
/// are 1 to 5 cm above a joint. The offset is the same in all frames of a person: it depends only
/// on where the markers are attached.
struct SideShift {
  double elbow_m = 0.0;       // along the line from the elbow to the shoulder
  double knee_along_m = 0.0;  // along the thigh to the hip
  /// Forward, perpendicular to the thigh and to the knee marker's direction.
  double knee_forward_m = 0.0;
};
struct FunctionalShifts {
  SideShift left, right;
};

/// The shifts of one person that minimise the variation of the lengths of forearms and shanks. 0 if
/// a limb was never completely seen. Every fifth frame is sufficient.
FunctionalShifts functional_shifts(const MarkerFrames& markers);

/// F frames of the 18 shared joints.
struct JointCentres {
  std::vector<double> positions;    // [F,18,3] m
  std::vector<std::uint8_t> valid;  // [F,18] 1 if all markers that the joint needs were seen

  std::size_t frames() const { return valid.size() / shared_joint_count; }
};

/// Computes the joints. `markers` should contain all frames of the person, because the size of the
/// pelvis is a median over them.
JointCentres joint_centres(const MarkerFrames& markers, const FunctionalShifts& shifts);

/// Interpolates invalid joints linearly between valid frames, so that a spline can be fitted. They
/// remain marked as invalid.
void fill_invalid(JointCentres& joints);

}  // namespace kinalign
