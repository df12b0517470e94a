// SPDX-License-Identifier: Apache-2.0
// From the samples of Xsens MVN to poses of its 23 segments and to inertial samples, in our axes.
#pragma once

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

/// Pelvis, L5, ... LeftToe: the segment of id k stands at k - 1.
std::span<const std::string_view, xsens_segments> xsens_segment_names();

/// What decides whether XsensPoser takes a pose, or XsensNodes a sample of trackers.
std::uint32_t xsens_shape(const XsensPose& pose);
std::uint32_t xsens_shape(const XsensTrackers& trackers);

/// Says of one shape after the other whether its sample is taken.
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
  std::optional<bool> raw_;  // the kind of items of the first sample
};

/// Poses of one character.
class XsensPoser {
 public:
  explicit XsensPoser(std::string name) : name_(std::move(name)) {}

  /// Appends the pose of the first 23 items. Type 02 has global places and rotations: local ones
  /// are computed, so local positions are those of each frame, not of a skeleton. Fails, and
  /// appends nothing, where one of the 23 segments lacks, comes twice, is no number or is not
  /// turned by a unit quaternion.
  Result<void> append(const XsensPose& pose, Time stamp, ClipFrames& out);

  /// The 23 segments; nullptr before the first pose, whose local positions are the rest offsets,
  /// since the stream has no rest pose.
  const Skeleton* skeleton() const { return skeleton_ ? &*skeleton_ : nullptr; }

  /// Which unit was seen, and by what.
  Findings findings;

 private:
  void begin(std::span<const double> heights, double reach);

  std::string name_;
  double metres_per_unit_ = 1.0;
  std::optional<Skeleton> skeleton_;
};

/// Inertial samples of one character.
class XsensNodes {
 public:
  explicit XsensNodes(std::string name) : name_(std::move(name)) {}

  /// Appends a sample of the trackers that the first sample had; those that lack, or hold what is
  /// no number, are not valid. Items of 68 bytes give acceleration with gravity and angular
  /// velocity; those of 44 bytes the free acceleration, turned into the sensor's space, without
  /// gravity. Fails where the kind of items changes or a first sample names a segment twice or none
  /// that is known.
  Result<void> append(const XsensTrackers& trackers, Time stamp, ImuSamples& out);

  const std::vector<std::string>& node_names() const { return node_names_; }
  /// Known after the first sample.
  const ImuContent& content() const { return content_; }

 private:
  Result<void> begin(const XsensTrackers& trackers);

  std::string name_;
  std::vector<std::int32_t> ids_;
  std::vector<std::string> node_names_;
  ImuContent content_;
};

}  // namespace kinalign
