// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/interpolation/clip_motion.h"

#include "kinalign/motion/interpolation/rotation_slopes.h"
#include "kinalign/motion/interpolation/spline.h"
#include "kinalign/motion/rotation.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace kinalign {

namespace {

/// A clip with its curves. Rows are frames.
struct Curves {
  std::size_t joints = 0;
  std::vector<double> times;      // [T] s from the first frame
  std::vector<double> positions;  // [T,J,3] m, of each joint in each frame
  std::vector<double> bends;      // [T,J,3] second derivatives of the positions
  std::vector<double> rotations;  // [T,J,4] w,x,y,z, of each joint in each frame
  // [T,J,6] angular rates at both ends of the interval that begins with the frame.
  std::vector<double> slopes;
};

/// Gaussian means over the rows near each row; `size` numbers per row. Quaternions must have
/// aligned signs; the caller normalises the results.
std::vector<double> smoothed(const std::vector<double>& times, const std::vector<double>& rows,
                             std::size_t size, double deviation_s) {
  std::vector<double> out(rows.size(), 0.0);
  std::size_t begin = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    // Beyond four deviations the weight is below 0.0004 of the middle one.
    while (times[i] - times[begin] > 4.0 * deviation_s) ++begin;
    double* to = &out[i * size];
    double sum = 0.0;
    for (std::size_t k = begin; k < times.size() && times[k] - times[i] <= 4.0 * deviation_s; ++k) {
      const double z = (times[k] - times[i]) / deviation_s, weight = std::exp(-0.5 * z * z);
      sum += weight;
      for (std::size_t c = 0; c < size; ++c) to[c] += weight * rows[k * size + c];
    }
    for (std::size_t c = 0; c < size; ++c) to[c] /= sum;
  }
  return out;
}

/// Chooses the sign of each quaternion so that it is near the quaternion before it. The mean of q
/// and -q would be zero, although both are the same rotation.
void align_signs(std::vector<double>& rotations, std::size_t joints) {
  for (std::size_t i = joints; i < rotations.size() / 4; ++i) {
    const Quat q = quat(rotations, i);
    if (q.dot(quat(rotations, i - joints)) < 0.0) put_quat(rotations, i, Quat(-q.coeffs()));
  }
}

/// Finds the slopes of the rotation spline, joint by joint.
void solve_rotations(Curves& curves) {
  const std::size_t frames = curves.times.size(), joints = curves.joints;
  curves.slopes.assign(6 * frames * joints, 0.0);
  if (frames < 2) return;
  std::vector<double> column(4 * frames);
  RotationIntervals intervals;
  RotationSlopes slopes;
  for (auto* end : {&slopes.begin, &slopes.end}) {
    for (auto& axis : *end) axis.resize(frames - 1);
  }
  for (std::size_t j = 0; j < joints; ++j) {
    for (std::size_t i = 0; i < frames; ++i) {
      put_quat(column, i, quat(curves.rotations, i * joints + j));
    }
    measure_intervals({curves.times, column}, intervals);
    slopes_by_blocks(intervals, slopes);
    for (std::size_t i = 0; i + 1 < frames; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        curves.slopes[6 * (i * joints + j) + axis] = slopes.begin[axis][i];
        curves.slopes[6 * (i * joints + j) + 3 + axis] = slopes.end[axis][i];
      }
    }
  }
}

/// The rotation spline in the interval that begins with frame k; the same formula as in
/// rotation_curve.cpp.
Quat rotation_at(const Curves& curves, std::size_t k, std::size_t joint, double t) {
  const std::size_t left = k * curves.joints + joint, right = left + curves.joints;
  const double h = curves.times[k + 1] - curves.times[k], u = (t - curves.times[k]) / h;
  const Quat from = quat(curves.rotations, left);
  const Vec3 turn = rotation_vector(from.conjugate() * quat(curves.rotations, right));
  const Vec3 begins = h * vec3(curves.slopes, 2 * left),
             ends = h * vec3(curves.slopes, 2 * left + 1);
  const Vec3 two = 3.0 * turn - 2.0 * begins - ends, three = begins + ends - 2.0 * turn;
  return from * rotation(Vec3(u * (begins + u * (two + u * three))));
}

/// Evaluates all curves at `time`. A clip of one frame is constant.
void pose_at(const Curves& curves, double time, Pose& pose) {
  const auto& times = curves.times;
  const std::size_t joints = curves.joints;
  const double t = std::clamp(time, 0.0, times.back());
  pose.local_positions.resize(joints);
  pose.local_rotations.resize(joints);
  if (times.size() == 1) {
    for (std::size_t j = 0; j < joints; ++j) {
      pose.local_positions[j] = vec3(curves.positions, j);
      pose.local_rotations[j] = quat(curves.rotations, j);
    }
    return;
  }
  // The first and the last time are left out of the search, so that k is a valid interval for every
  // t.
  const auto behind = std::upper_bound(times.begin() + 1, times.end() - 1, t);
  const auto k = static_cast<std::size_t>(behind - times.begin()) - 1;
  const std::span all_positions(curves.positions), all_bends(curves.bends);
  const Knots knots{std::span(times).subspan(k, 2),
                    all_positions.subspan(3 * joints * k, 6 * joints), 3 * joints};
  spline_at(knots, all_bends.subspan(3 * joints * k, 6 * joints), {&t, 1},
            {pose.local_positions.front().data(), 3 * joints});
  for (std::size_t j = 0; j < joints; ++j) pose.local_rotations[j] = rotation_at(curves, k, j, t);
}

/// Fails if the clip can't be interpolated.
Result<void> check(const Clip& clip) {
  KA_TRY(validate(clip.skeleton));
  const std::size_t joints = clip.skeleton.joints(), frames = clip.frames.size();
  if (joints == 0 || frames == 0) {
    return Failure(
        Error{"", 0, "a clip with joints and frames",
              std::to_string(joints) + " joints, " + std::to_string(frames) + " frames"});
  }
  if (clip.frames.local_positions.size() != 3 * joints * frames ||
      clip.frames.local_rotations.size() != 4 * joints * frames) {
    return Failure(Error{"", 0, "a position and a rotation for each joint and frame",
                         "arrays of other lengths"});
  }
  for (std::size_t i = 1; i < frames; ++i) {
    if (clip.frames.stamps[i] > clip.frames.stamps[i - 1]) continue;
    return Failure(Error{"", 0, "rising stamps", "frame " + std::to_string(i) + " does not rise"});
  }
  for (const auto* numbers : {&clip.frames.local_positions, &clip.frames.local_rotations}) {
    if (std::all_of(numbers->begin(), numbers->end(), [](double x) { return std::isfinite(x); })) {
      continue;
    }
    return Failure(Error{"", 0, "finite positions and rotations", "NaN or infinity"});
  }
  return {};
}

}  // namespace

Result<Motion> motion_of(const Clip& clip, const ClipMotionOptions& options) {
  KA_TRY(check(clip));
  Curves curves;
  curves.joints = clip.skeleton.joints();
  for (const Time stamp : clip.frames.stamps) {
    curves.times.push_back(seconds(stamp - clip.frames.stamps.front()));
  }
  curves.positions = clip.frames.local_positions;
  curves.rotations = clip.frames.local_rotations;
  // The signs are aligned before the means are taken.
  align_signs(curves.rotations, curves.joints);
  if (options.smooth_s > 0.0) {
    curves.positions =
        smoothed(curves.times, curves.positions, 3 * curves.joints, options.smooth_s);
    curves.rotations =
        smoothed(curves.times, curves.rotations, 4 * curves.joints, options.smooth_s);
  }
  // A mean of unit quaternions is shorter than 1.
  for (std::size_t i = 0; i < curves.rotations.size() / 4; ++i) {
    put_quat(curves.rotations, i, quat(curves.rotations, i).normalized());
  }
  curves.bends.resize(curves.positions.size());
  natural_spline({curves.times, curves.positions, 3 * curves.joints}, curves.bends);
  solve_rotations(curves);
  const double length = curves.times.back();
  return Motion{clip.skeleton, length,
                [curves = std::move(curves)](double t, Pose& pose) { pose_at(curves, t, pose); }};
}

}  // namespace kinalign
