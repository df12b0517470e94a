// SPDX-License-Identifier: Apache-2.0
// Vectors and quaternions of eight independent computations, the lanes. A loop over the lanes that
// loads, computes and stores becomes vector code. Eight numbers fill a cache line. Structures of
// them are aligned to it (alignas), which makes the loops twice as fast.
#pragma once

#include "kinalign/motion/targets.h"

#include <array>
#include <cstddef>

namespace kinalign {

constexpr std::size_t lanes = 8;
using Lane = std::array<double, lanes>;
using VectorLanes = std::array<Lane, 3>;
using QuaternionLanes = std::array<Lane, 4>;  // w, x, y, z

struct Vector {
  double x, y, z;
};
KA_INLINE Vector load(const VectorLanes& v, std::size_t i) { return {v[0][i], v[1][i], v[2][i]}; }
KA_INLINE void store(const Vector& v, VectorLanes& to, std::size_t i) {
  to[0][i] = v.x, to[1][i] = v.y, to[2][i] = v.z;
}
KA_INLINE Vector operator+(const Vector& a, const Vector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
KA_INLINE Vector operator-(const Vector& a, const Vector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
KA_INLINE Vector operator*(double s, const Vector& v) { return {s * v.x, s * v.y, s * v.z}; }
KA_INLINE double dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
KA_INLINE Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

struct Quaternion {
  double w;
  Vector v;
};
KA_INLINE Quaternion load(const QuaternionLanes& q, std::size_t i) {
  return {q[0][i], {q[1][i], q[2][i], q[3][i]}};
}
KA_INLINE void store(const Quaternion& q, QuaternionLanes& to, std::size_t i) {
  to[0][i] = q.w, to[1][i] = q.v.x, to[2][i] = q.v.y, to[3][i] = q.v.z;
}
KA_INLINE Quaternion conjugate(const Quaternion& q) { return {q.w, -1.0 * q.v}; }
KA_INLINE Quaternion operator*(const Quaternion& a, const Quaternion& b) {
  return {a.w * b.w - dot(a.v, b.v), a.w * b.v + b.w * a.v + cross(a.v, b.v)};
}
/// The vector v rotated by a unit quaternion.
KA_INLINE Vector turned(const Quaternion& q, const Vector& v) {
  const Vector t = 2.0 * cross(q.v, v);
  return v + q.w * t + cross(q.v, t);
}

}  // namespace kinalign
