// SPDX-License-Identifier: Apache-2.0
// The only code that knows the order of components in arrays: x,y,z and w,x,y,z. `auto` is correct
// for the results of vec3() (they are views) and for no other Eigen expression.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <span>
#include <vector>

namespace kinalign {

using Vec3 = Eigen::Vector3d;
using Quat = Eigen::Quaterniond;

/// The i-th vector of an array of x,y,z triples, for reading and writing.
/// The view writes into the array; a Vec3 copied from it does not.
inline Eigen::Map<Vec3> vec3(std::span<double> array, std::size_t i) {
  return Eigen::Map<Vec3>(&array[3 * i]);
}
inline Eigen::Map<const Vec3> vec3(std::span<const double> array, std::size_t i) {
  return Eigen::Map<const Vec3>(&array[3 * i]);
}
inline Eigen::Map<Vec3> vec3(std::vector<double>& array, std::size_t i) {
  return vec3(std::span<double>(array), i);
}
inline Eigen::Map<const Vec3> vec3(const std::vector<double>& array, std::size_t i) {
  return vec3(std::span<const double>(array), i);
}

/// The i-th rotation of an array of w,x,y,z quadruples.
/// A copy, because Eigen stores x,y,z,w and the array w,x,y,z.
inline Quat quat(std::span<const double> array, std::size_t i) {
  return {array[4 * i], array[4 * i + 1], array[4 * i + 2], array[4 * i + 3]};
}
inline void put_quat(std::span<double> array, std::size_t i, const Quat& q) {
  array[4 * i] = q.w();
  array[4 * i + 1] = q.x();
  array[4 * i + 2] = q.y();
  array[4 * i + 3] = q.z();
}

}  // namespace kinalign
