// SPDX-License-Identifier: Apache-2.0
// Processes 16 frames at a time, with a structure of arrays that the compiler turns into vector
// code. This takes 0.4 of the time of one joint at a time with Eigen (bench/kinematics_bench.cpp).
#include "kinalign/motion/kinematics.h"

#include "kinalign/motion/targets.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <vector>

namespace kinalign {

namespace {

constexpr std::size_t block = 16;
constexpr std::size_t few = 3;  // with fewer lanes a loop lane by lane is faster
using Lane = std::array<double, block>;

// Computes sine and cosine of half an angle in degrees from a quarter of it. The angle is reduced
// to +-180 degrees, so the quarter is within +-45, where Taylor's series of degree 15 and 16 is
// exact to 5e-17.
KA_INLINE void half_angle(double degrees, double& sine, double& cosine) {
  constexpr double to_integer =
      0x1.8p52;  // adding and subtracting it rounds to the nearest integer
  const double turns = (degrees * (1.0 / 360.0) + to_integer) - to_integer;
  const double x = (degrees - 360.0 * turns) * (std::numbers::pi / 720.0);
  const double x2 = x * x;
  double s = -1.0 / 1307674368000.0;
  s = s * x2 + 1.0 / 6227020800.0;
  s = s * x2 - 1.0 / 39916800.0;
  s = s * x2 + 1.0 / 362880.0;
  s = s * x2 - 1.0 / 5040.0;
  s = s * x2 + 1.0 / 120.0;
  s = s * x2 - 1.0 / 6.0;
  s = s * x2 * x + x;
  double c = 1.0 / 20922789888000.0;
  c = c * x2 - 1.0 / 87178291200.0;
  c = c * x2 + 1.0 / 479001600.0;
  c = c * x2 - 1.0 / 3628800.0;
  c = c * x2 + 1.0 / 40320.0;
  c = c * x2 - 1.0 / 720.0;
  c = c * x2 + 1.0 / 24.0;
  c = c * x2 * x2 - 0.5 * x2 + 1.0;
  sine = 2.0 * s * c;
  cosine = 1.0 - 2.0 * s * s;
}

/// +1 if the axes a, b and the third one are an even permutation of x, y, z, else -1.
double parity(int a, int b) { return (b - a + 3) % 3 == 1 ? 1.0 : -1.0; }

struct Rotations {
  std::array<Lane, 4> part;  // w, x, y, z
};

// Multiplies three elementary rotations about different axes: q = q_a q_b q_c. `sign` is the parity
// of the permutation. The vector parts are ordered by the axes a, b, c.
KA_INLINE void compose_lane(const std::array<Lane, 3>& degrees, double sign, std::size_t i,
                            Rotations& q) {
  double sa = 0.0, ca = 0.0, sb = 0.0, cb = 0.0, sc = 0.0, cc = 0.0;
  half_angle(degrees[0][i], sa, ca);
  half_angle(degrees[1][i], sb, cb);
  half_angle(degrees[2][i], sc, cc);
  const double cacb = ca * cb, sasb = sa * sb, sacb = sa * cb, casb = ca * sb;
  q.part[0][i] = cacb * cc - sign * (sasb * sc);
  q.part[1][i] = sacb * cc + sign * (casb * sc);
  q.part[2][i] = casb * cc - sign * (sacb * sc);
  q.part[3][i] = cacb * sc + sign * (sasb * cc);
}

KA_EVERY_PROCESSOR
void compose(const std::array<Lane, 3>& degrees, double sign, Rotations& q) {
  for (std::size_t i = 0; i < block; ++i) compose_lane(degrees, sign, i, q);
}

/// Multiplies only the first lanes. Streams deliver frames one by one, so most lanes are then
/// empty.
void compose_few(const std::array<Lane, 3>& degrees, double sign, std::size_t lanes, Rotations& q) {
  for (std::size_t i = 0; i < lanes; ++i) compose_lane(degrees, sign, i, q);
}

// Computes one joint of the chain for a block of frames: rotation = parent's rotation * local
// rotation, position = parent's position + parent's rotation * offset. `global` parts: 0..3
// rotation, 4..6 position.
using Pose = std::array<Lane, 7>;

KA_EVERY_PROCESSOR
void follow(const Pose& parent, const Pose& local, Pose& global) {
  for (std::size_t i = 0; i < block; ++i) {
    const double w = parent[0][i], x = parent[1][i], y = parent[2][i], z = parent[3][i];
    const double lw = local[0][i], lx = local[1][i], ly = local[2][i], lz = local[3][i];
    global[0][i] = w * lw - x * lx - y * ly - z * lz;
    global[1][i] = w * lx + x * lw + y * lz - z * ly;
    global[2][i] = w * ly - x * lz + y * lw + z * lx;
    global[3][i] = w * lz + x * ly - y * lx + z * lw;
    const double px = local[4][i], py = local[5][i], pz = local[6][i];
    // v + 2 w (u x v) + 2 u x (u x v), where w is the scalar part and u the vector part
    const double tx = 2.0 * (y * pz - z * py), ty = 2.0 * (z * px - x * pz),
                 tz = 2.0 * (x * py - y * px);
    global[4][i] = parent[4][i] + px + w * tx + (y * tz - z * ty);
    global[5][i] = parent[5][i] + py + w * ty + (z * tx - x * tz);
    global[6][i] = parent[6][i] + pz + w * tz + (x * ty - y * tx);
  }
}

/// Loads joint j from frame `first` on, one frame per lane. Lanes beyond the last frame get the
/// last frame.
void load(const ClipFrames& frames, std::size_t joints, std::size_t first, std::size_t j,
          Pose& pose) {
  const std::size_t last = std::min(block, frames.size() - first) - 1;
  const double* q = &frames.local_rotations[4 * (first * joints + j)];
  const double* p = &frames.local_positions[3 * (first * joints + j)];
  for (std::size_t i = 0; i < block; ++i) {
    for (std::size_t k = 0; k < 4; ++k) pose[k][i] = q[k];
    for (std::size_t k = 0; k < 3; ++k) pose[4 + k][i] = p[k];
    if (i >= last) continue;
    q += 4 * joints;
    p += 3 * joints;
  }
}

}  // namespace

void rotations_from_euler(const EulerOrder& order, const EulerColumns& columns,
                          std::size_t frames) {
  const double sign = parity(order.first, order.second);
  std::array<Lane, 3> degrees{};
  Rotations q{};
  for (std::size_t first = 0; first < frames; first += block) {
    const std::size_t lanes = std::min(block, frames - first);
    for (std::size_t k = 0; k < 3; ++k) {
      if (columns.angles[k] == nullptr) continue;
      const double* from = columns.angles[k] + first * columns.stride;
      for (std::size_t i = 0; i < lanes; ++i, from += columns.stride) degrees[k][i] = *from;
    }
    if (lanes < few) {
      compose_few(degrees, sign, lanes, q);
    } else {
      // Lanes beyond `lanes` hold values of the last block; they are computed, too, but never
      // written.
      compose(degrees, sign, q);
    }
    double* to = columns.rotations + first * columns.rotation_stride;
    for (std::size_t i = 0; i < lanes; ++i, to += columns.rotation_stride) {
      // The vector part is in the order of the rotations and is put into the order x, y, z here.
      to[0] = q.part[0][i];
      to[1 + order.first] = q.part[1][i];
      to[1 + order.second] = q.part[2][i];
      to[1 + order.third] = q.part[3][i];
    }
  }
}

void forward_kinematics(const Skeleton& skeleton, const ClipFrames& frames,
                        std::span<double> global) {
  const std::size_t joints = skeleton.joints();
  std::vector<Pose> poses(joints);
  Pose local;
  for (std::size_t first = 0; first < frames.size(); first += block) {
    const std::size_t lanes = std::min(block, frames.size() - first);
    for (std::size_t j = 0; j < joints; ++j) {
      const int parent = skeleton.parents[j];
      if (parent < 0) {
        load(frames, joints, first, j, poses[j]);
      } else {
        load(frames, joints, first, j, local);
        // poses[parent] belongs to the same block, because parents come first.
        follow(poses[static_cast<std::size_t>(parent)], local, poses[j]);
      }
      double* to = &global[3 * (first * joints + j)];
      for (std::size_t i = 0; i < lanes; ++i, to += 3 * joints) {
        for (std::size_t k = 0; k < 3; ++k) to[k] = poses[j][4 + k][i];
      }
    }
  }
}

}  // namespace kinalign
