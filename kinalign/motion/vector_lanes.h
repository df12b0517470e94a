// SPDX-License-Identifier: Apache-2.0
// Vectors and matrices of eight pieces of work side by side: a loop over the lanes that loads,
// computes and stores becomes vector code.
#pragma once

#include "kinalign/motion/targets.h"

#include <array>
#include <cstddef>

namespace kinalign {

constexpr std::size_t lanes = 8;
using Lane = std::array<double, lanes>;
using VectorLanes = std::array<Lane, 3>;
using MatrixLanes = std::array<Lane, 9>;  // row-major

/// One lane, row by row.
struct Matrix {
  double xx, xy, xz, yx, yy, yz, zx, zy, zz;
};
KA_INLINE Matrix load(const MatrixLanes& m, std::size_t i) {
  return {m[0][i], m[1][i], m[2][i], m[3][i], m[4][i], m[5][i], m[6][i], m[7][i], m[8][i]};
}

KA_INLINE void store(const Matrix& m, MatrixLanes& to, std::size_t i) {
  to[0][i] = m.xx, to[1][i] = m.xy, to[2][i] = m.xz;
  to[3][i] = m.yx, to[4][i] = m.yy, to[5][i] = m.yz;
  to[6][i] = m.zx, to[7][i] = m.zy, to[8][i] = m.zz;
}

KA_INLINE Matrix operator*(const Matrix& a, const Matrix& b) {
  return {a.xx * b.xx + a.xy * b.yx + a.xz * b.zx, a.xx * b.xy + a.xy * b.yy + a.xz * b.zy,
          a.xx * b.xz + a.xy * b.yz + a.xz * b.zz, a.yx * b.xx + a.yy * b.yx + a.yz * b.zx,
          a.yx * b.xy + a.yy * b.yy + a.yz * b.zy, a.yx * b.xz + a.yy * b.yz + a.yz * b.zz,
          a.zx * b.xx + a.zy * b.yx + a.zz * b.zx, a.zx * b.xy + a.zy * b.yy + a.zz * b.zy,
          a.zx * b.xz + a.zy * b.yz + a.zz * b.zz};
}

struct Vector {
  double x, y, z;
};

KA_INLINE Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
KA_INLINE Vector load(const VectorLanes& v, std::size_t i) { return {v[0][i], v[1][i], v[2][i]}; }
KA_INLINE void store(const Vector& v, VectorLanes& to, std::size_t i) {
  to[0][i] = v.x, to[1][i] = v.y, to[2][i] = v.z;
}
KA_INLINE Vector operator*(const Matrix& m, const Vector& v) {
  return {m.xx * v.x + m.xy * v.y + m.xz * v.z, m.yx * v.x + m.yy * v.y + m.yz * v.z,
          m.zx * v.x + m.zy * v.y + m.zz * v.z};
}

}  // namespace kinalign
