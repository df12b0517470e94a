// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/pairs/plug_in_gait.h"

#include "kinalign/motion/arrays.h"
#include "kinalign/motion/pairs/nelder_mead.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace kinalign {

namespace {

constexpr std::size_t marker_count = plug_in_gait_markers.size();

enum Marker : std::size_t {  // in the order of plug_in_gait_markers
  lfhd,
  rfhd,
  lbhd,
  rbhd,
  c7,
  t10,
  clav,
  strn,
  rbak,
  lsho,
  lupa,
  lelb,
  lfrm,
  lwra,
  lwrb,
  lfin,
  rsho,
  rupa,
  relb,
  rfrm,
  rwra,
  rwrb,
  rfin,
  lasi,
  rasi,
  lpsi,
  rpsi,
  lthi,
  lkne,
  ltib,
  lank,
  lhee,
  ltoe,
  rthi,
  rkne,
  rtib,
  rank,
  rhee,
  rtoe
};
static_assert(plug_in_gait_markers[rtoe] == "RTOE" && plug_in_gait_markers[lasi] == "LASI");

enum Joint : std::size_t {  // in the order of shared_joints
  spine_base = 0,
  spine_mid = 1,
  spine_shoulder = 2,
  head = 3,
  left_arm = 4,
  right_arm = 7,
  left_leg = 10,
  right_leg = 14
};

/// The markers of one side of the body, the indices of its first joints, and the sign of the left
/// direction.
/// `left` is 1 on the left and -1 on the right, so one formula serves both sides.
struct Side {
  std::size_t arm, leg;  // first of shoulder, elbow, wrist; first of hip, knee, ankle, foot
  Marker shoulder, elbow, wrist_a, wrist_b, thigh, knee, shank, ankle, toe;
  double left;
};
constexpr Side left_side{left_arm, left_leg, lsho, lelb, lwra, lwrb,
                         lthi,     lkne,     ltib, lank, ltoe, 1.0};
constexpr Side right_side{right_arm, right_leg, rsho, relb, rwra, rwrb,
                          rthi,      rkne,      rtib, rank, rtoe, -1.0};

constexpr double shoulder_below_marker_m = 0.05;
// The distance from the lateral marker to the joint's centre.
constexpr double knee_depth_m = 0.057, ankle_depth_m = 0.042;
constexpr double least_width_m = 0.20, most_width_m = 0.30;  // width of a pelvis

// The limit avoids a division by zero for markers that were not seen, whose positions are zeros.
Vec3 unit(const Vec3& v) { return v / std::max(v.norm(), 1e-11); }

/// Plug-in-Gait's chord function. The joint's centre is `depth` from the lateral marker, at a right
/// angle to the segment. It lies in the plane of the joint above, the marker and the wand marker,
/// on the side away from the wand.
Vec3 chord(const Vec3& above, const Vec3& marker, const Vec3& wand, double depth) {
  const Vec3 segment = above - marker, to_wand = wand - marker;
  const double length = std::max(segment.norm(), 1e-11);
  const Vec3 along = segment / length;
  const Vec3 side = unit(to_wand - to_wand.dot(along) * along);
  // The angle at the joint is a right one, so `a` is the part of the depth along the segment.
  const double a = depth * depth / length;
  return marker + a * along - std::sqrt(std::max(depth * depth - a * a, 0.0)) * side;
}

struct ThighAxes {
  Vec3 along, forward;
};
ThighAxes thigh_axes(const Vec3& hip, const Vec3& knee, const Vec3& marker, const Side& side) {
  const Vec3 along = unit(hip - knee);
  return {along, side.left * unit(marker - knee).cross(along)};
}

/// The mean of the two middle values if their number is even, as NumPy's median.
double median(std::vector<double> values) {
  const auto upper = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), upper, values.end());
  if (values.size() % 2 == 1) return *upper;
  return 0.5 * (*upper + *std::max_element(values.begin(), upper));
}

/// The markers of one frame.
/// A marker that is not seen reads as zeros. Callers compute with it and mark the joint as invalid.
class MarkerFrame {
 public:
  MarkerFrame(const MarkerFrames& all, std::size_t frame) : all_(all), at_(frame * marker_count) {}

  Vec3 operator[](Marker m) const { return vec3(all_.positions, at_ + m); }
  bool sees(std::initializer_list<Marker> markers) const {
    return std::all_of(markers.begin(), markers.end(),
                       [this](Marker m) { return all_.seen[at_ + m] != 0; });
  }
  bool sees_pelvis() const { return sees({lasi, rasi, lpsi, rpsi}); }
  Vec3 front() const { return ((*this)[lasi] + (*this)[rasi]) / 2.0; }
  Vec3 depth() const { return front() - ((*this)[lpsi] + (*this)[rpsi]) / 2.0; }
  Vec3 width() const { return (*this)[lasi] - (*this)[rasi]; }

 private:
  const MarkerFrames& all_;
  std::size_t at_;
};

struct PelvisSize {
  double depth_m = 0.0, width_m = 0.0;
};

/// One size for all frames, because the bones do not change. Frames with wrong labels hardly
/// change a median.
PelvisSize pelvis_size(const MarkerFrames& markers) {
  std::vector<double> depths, widths;
  for (std::size_t t = 0; t < markers.frames(); ++t) {
    const MarkerFrame frame(markers, t);
    if (!frame.sees_pelvis()) continue;
    depths.push_back(frame.depth().norm());
    widths.push_back(frame.width().norm());
  }
  // Without a frame that shows the pelvis no hip is valid, so the size does not matter.
  if (depths.empty()) return {0.0, least_width_m};
  return {median(depths), std::clamp(median(widths), least_width_m, most_width_m)};
}

/// Writes the joints of one frame into the arrays. Each function reads joints that earlier
/// functions wrote, so the order of calls matters.
class FrameJoints {
 public:
  FrameJoints(JointCentres& out, std::size_t frame) : out_(out), at_(frame * shared_joint_count) {}

  void put(std::size_t joint, const Vec3& place, bool valid) {
    vec3(out_.positions, at_ + joint) = place;
    out_.valid[at_ + joint] = valid ? 1 : 0;
  }
  Vec3 operator[](std::size_t joint) const { return vec3(out_.positions, at_ + joint); }

 private:
  JointCentres& out_;
  std::size_t at_;
};

/// Hip joints by Harrington's regression, in the axes of the pelvis.
void put_hips(const MarkerFrame& m, const PelvisSize& size, FrameJoints& out) {
  const Vec3 y = unit(m.width());
  const Vec3 x = unit(m.depth() - m.depth().dot(y) * y);
  // x: forward, y: to the left, z: up, the axes of the pelvis.
  const Vec3 z = x.cross(y);
  // The regression's numbers are in metres here; the paper's are in millimetres.
  const double forward = -0.24 * size.depth_m - 0.0099, up = -0.30 * size.width_m - 0.0109;
  const double outward = 0.33 * size.width_m + 0.0073;
  const bool valid = m.sees_pelvis();
  const Vec3 middle = m.front() + forward * x + up * z;
  out.put(left_leg, middle + outward * y, valid);
  out.put(right_leg, middle - outward * y, valid);
  out.put(spine_base, middle, valid);
}

void put_trunk(const MarkerFrame& m, FrameJoints& out) {
  out.put(spine_mid, (m[t10] + m[strn]) / 2.0, m.sees({t10, strn}));
  out.put(spine_shoulder, (m[c7] + m[clav]) / 2.0, m.sees({c7, clav}));
  out.put(head, (m[lfhd] + m[rfhd] + m[lbhd] + m[rbhd]) / 4.0, m.sees({lfhd, rfhd, lbhd, rbhd}));
}

void put_arm(const MarkerFrame& m, const Side& s, const SideShift& shift, FrameJoints& out) {
  // The trunk gives the direction of up, so put_trunk() comes first.
  const Vec3 up = unit(out[spine_shoulder] - out[spine_mid]);
  const Vec3 shoulder = m[s.shoulder] - shoulder_below_marker_m * up;
  out.put(s.arm, shoulder, m.sees({s.shoulder, t10, strn, c7, clav}));
  const Vec3 elbow = m[s.elbow];
  out.put(s.arm + 1, elbow + shift.elbow_m * unit(shoulder - elbow), m.sees({s.elbow}));
  out.put(s.arm + 2, (m[s.wrist_a] + m[s.wrist_b]) / 2.0, m.sees({s.wrist_a, s.wrist_b}));
}

void put_leg(const MarkerFrame& m, const Side& s, const SideShift& shift, FrameJoints& out) {
  // The hip was written by put_hips().
  const Vec3 hip = out[s.leg];
  const Vec3 unmoved = chord(hip, m[s.knee], m[s.thigh], knee_depth_m);
  const ThighAxes axes = thigh_axes(hip, unmoved, m[s.knee], s);
  const Vec3 knee = unmoved + shift.knee_along_m * axes.along + shift.knee_forward_m * axes.forward;
  const bool sees_knee = m.sees_pelvis() && m.sees({s.knee, s.thigh});
  // A joint is valid only if the markers of the joints above it were seen, too.
  out.put(s.leg + 1, knee, sees_knee);
  out.put(s.leg + 2, chord(knee, m[s.ankle], m[s.shank], ankle_depth_m),
          sees_knee && m.sees({s.ankle, s.shank}));
  out.put(s.leg + 3, m[s.toe], m.sees({s.toe}));
}

/// Standard deviation of the population.
double deviation(const std::vector<double>& values) {
  double sum = 0.0, square = 0.0;
  for (const double v : values) sum += v;
  const double mean = sum / static_cast<double>(values.size());
  for (const double v : values) square += (v - mean) * (v - mean);
  return std::sqrt(square / static_cast<double>(values.size()));
}

constexpr double cm = 0.01;  // m; the minimiser's tolerances suit numbers in centimetres

/// The frames in which `count` joints, from joint `first` on, are all valid.
std::vector<std::size_t> whole_frames(const JointCentres& joints, std::size_t first,
                                      std::size_t count) {
  std::vector<std::size_t> out;
  for (std::size_t t = 0; t < joints.frames(); ++t) {
    const auto begin =
        joints.valid.begin() + static_cast<std::ptrdiff_t>(t * shared_joint_count + first);
    if (std::all_of(begin, begin + static_cast<std::ptrdiff_t>(count),
                    [](std::uint8_t valid) { return valid != 0; })) {
      out.push_back(t);
    }
  }
  return out;
}

/// The shift of the elbow, m, that minimises the variation of the forearm's length.
double elbow_shift(const JointCentres& joints, const Side& side) {
  // Shoulder, elbow and wrist.
  const auto frames = whole_frames(joints, side.arm, 3);
  if (frames.empty()) return 0.0;
  std::vector<double> lengths(frames.size());
  // The forearm is a bone, so the true elbow is where the forearm's length varies least.
  const auto cost = [&](std::span<const double> shift) {
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const std::size_t at = frames[i] * shared_joint_count + side.arm;
      const Vec3 shoulder = vec3(joints.positions, at), elbow = vec3(joints.positions, at + 1);
      const Vec3 wrist = vec3(joints.positions, at + 2);
      lengths[i] = (elbow + shift[0] * cm * unit(shoulder - elbow) - wrist).norm();
    }
    return deviation(lengths) / cm;
  };
  return cm * minimise(cost, {0.0})[0];
}

/// Finds the knee's shift along and across the thigh that minimises the variation of the shank's
/// length.
void put_knee_shift(const MarkerFrames& markers, const JointCentres& joints, const Side& side,
                    SideShift& out) {
  // Hip, knee and ankle.
  const auto frames = whole_frames(joints, side.leg, 3);
  if (frames.empty()) return;
  std::vector<double> lengths(frames.size());
  const auto cost = [&](std::span<const double> shift) {
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const MarkerFrame m(markers, frames[i]);
      const std::size_t at = frames[i] * shared_joint_count + side.leg;
      const Vec3 hip = vec3(joints.positions, at), unmoved = vec3(joints.positions, at + 1);
      // The ankle depends on the knee, so it is computed again for each shift.
      const ThighAxes axes = thigh_axes(hip, unmoved, m[side.knee], side);
      const Vec3 knee = unmoved + shift[0] * cm * axes.along + shift[1] * cm * axes.forward;
      lengths[i] = (knee - chord(knee, m[side.ankle], m[side.shank], ankle_depth_m)).norm();
    }
    return deviation(lengths) / cm;
  };
  const std::vector<double> found = minimise(cost, {0.0, 0.0});
  out.knee_along_m = cm * found[0];
  out.knee_forward_m = cm * found[1];
}

SideShift side_shift(const MarkerFrames& markers, const JointCentres& joints, const Side& side) {
  SideShift out;
  out.elbow_m = elbow_shift(joints, side);
  put_knee_shift(markers, joints, side, out);
  return out;
}

/// Fills the invalid frames of one joint by the rule of np.interp: beyond both ends the nearest
/// valid frame is used.
void fill_joint(JointCentres& joints, std::size_t j) {
  const auto cell = [j](std::size_t t) { return t * shared_joint_count + j; };
  std::vector<std::size_t> good;
  for (std::size_t t = 0; t < joints.frames(); ++t) {
    if (joints.valid[cell(t)] != 0) good.push_back(t);
  }
  const auto place = [&](std::size_t t) -> Vec3 {
    if (good.empty()) return Vec3::Zero();
    const auto after = std::upper_bound(good.begin(), good.end(), t);
    if (after == good.begin()) return vec3(joints.positions, cell(good.front()));
    if (after == good.end()) return vec3(joints.positions, cell(good.back()));
    const std::size_t a = *(after - 1), b = *after;
    const double share = static_cast<double>(t - a) / static_cast<double>(b - a);
    const Vec3 from = vec3(joints.positions, cell(a)), to = vec3(joints.positions, cell(b));
    return from + share * (to - from);
  };
  for (std::size_t t = 0; t < joints.frames(); ++t) {
    if (joints.valid[cell(t)] == 0) vec3(joints.positions, cell(t)) = place(t);
  }
}

}  // namespace

FunctionalShifts functional_shifts(const MarkerFrames& markers) {
  // The joints without shifts are the start of the search.
  const JointCentres joints = joint_centres(markers, {});
  return {side_shift(markers, joints, left_side), side_shift(markers, joints, right_side)};
}

JointCentres joint_centres(const MarkerFrames& markers, const FunctionalShifts& shifts) {
  const std::size_t frames = markers.frames();
  JointCentres out{std::vector<double>(3 * shared_joint_count * frames),
                   std::vector<std::uint8_t>(shared_joint_count * frames)};
  const PelvisSize size = pelvis_size(markers);
  for (std::size_t t = 0; t < frames; ++t) {
    const MarkerFrame m(markers, t);
    FrameJoints joints(out, t);
    // The order matters: hips before legs, trunk before arms.
    put_hips(m, size, joints);
    put_trunk(m, joints);
    put_arm(m, left_side, shifts.left, joints);
    put_arm(m, right_side, shifts.right, joints);
    put_leg(m, left_side, shifts.left, joints);
    put_leg(m, right_side, shifts.right, joints);
  }
  return out;
}

void fill_invalid(JointCentres& joints) {
  for (std::size_t j = 0; j < shared_joint_count; ++j) fill_joint(joints, j);
}

}  // namespace kinalign
