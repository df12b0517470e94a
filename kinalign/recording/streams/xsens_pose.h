// SPDX-License-Identifier: Apache-2.0
// Converts samples of Xsens MVN to poses of its 23 segments and to inertial samples, in kinalign's
// axes.
#pragma once

#include "kinalign/formats/reader.h"
#include "kinalign/motion/clip.h"
#include "kinalign/motion/streams.h"
#include "kinalign/protocols/xsens/sample.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace kinalign {

constexpr std::size_t xsens_segments = 23;

/// A number that decides whether XsensPoser accepts a pose, or XsensNodes a sample of trackers.
std::uint32_t xsens_shape(const XsensPose& pose);
std::uint32_t xsens_shape(const XsensTrackers& trackers);

/// Decides for each sample whether it is accepted, by the sample's shape (see xsens_shape()).
template <class Items>
class XsensFits;
template <>
class XsensFits<XsensPose> {
 public:
  bool operator()(std::uint32_t shape) const { return shape != 0; }
};
template <>
class XsensFits<XsensTrackers> {
 public:
  bool operator()(std::uint32_t shape);

 private:
  std::optional<bool> raw_;  // whether the first sample had raw values
};

/// Makes the poses of one character. The first pose determines the skeleton and the unit of length
/// for the whole stream.
class XsensPoser {
 public:
  explicit XsensPoser(std::string name) : name_(std::move(name)) {}

  /// Appends the pose of the first 23 items. Type 02 contains global positions and rotations, from
  /// which local ones are computed. The local positions therefore differ from frame to frame. Fails
  /// and appends nothing if one of the 23 segments is missing or occurs twice, if a value is not a
  /// number, or if a quaternion is not a unit quaternion.
  Result<void> append(const XsensPose& pose, Time stamp, ClipFrames& out);

  /// The 23 segments; nullptr before the first pose. The stream has no rest pose, so the local
  /// positions of the first pose serve as rest offsets.
  const Skeleton* skeleton() const { return skeleton_ ? &*skeleton_ : nullptr; }

  /// The unit of length, and the reason why it was chosen.
  Findings findings;

 private:
  void begin(std::span<const double> heights, double reach);

  std::string name_;
  double metres_per_unit_ = 1.0;
  std::optional<Skeleton> skeleton_;
};

/// Makes the inertial samples of one character. The first sample determines the trackers, their
/// order and their quantities.
class XsensNodes {
 public:
  explicit XsensNodes(std::string name) : name_(std::move(name)) {}

  /// Appends a sample of the trackers that the first sample has. If a tracker is missing or has a
  /// value that is not a number, it is marked as invalid. Items of 68 bytes contain acceleration
  /// with gravity and angular velocity. Items of 44 bytes contain the acceleration without gravity,
  /// which is rotated into the sensor's space. Fails if the kind of items changes, or if the first
  /// sample has an unknown segment or the same segment twice.
  Result<void> append(const XsensTrackers& trackers, Time stamp, ImuSamples& out);

  /// The header; nullptr before the first sample.
  const ImuHeader* header() const { return ids_.empty() ? nullptr : &header_; }

 private:
  Result<void> begin(const XsensTrackers& trackers);

  std::string name_;
  std::vector<std::int32_t> ids_;
  ImuHeader header_;
};

}  // namespace kinalign
