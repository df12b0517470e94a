// SPDX-License-Identifier: Apache-2.0
// Finds the recorded person among the bodies that a Kinect sees. If the SDK loses a body and finds
// it again, the body gets a new id. Other people in view have ids, too.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/motion/arrays.h"
#include "kinalign/protocols/kinect/message.h"

#include <cstdint>
#include <optional>
#include <set>
#include <string>

namespace kinalign {

/// Begins with the body nearest to the sensor and follows its id. If the id disappears, a body near
/// the last position continues. A body that was seen apart from the person before is somebody else
/// and never continues.
class KinectPerson {
 public:
  /// If `wanted` is given, only this id is used.
  explicit KinectPerson(std::optional<std::uint64_t> wanted) : wanted_(wanted) {}

  /// The id to use in the next frame; empty if the person is not in the frame.
  std::optional<std::uint64_t> operator()(const KinectFrame& frame);

  void report(const std::string& file, Findings& findings) const;

 private:
  // The body to follow in the frame; nullptr if no body may be the person.
  const KinectBody* body_in(const KinectFrame& frame) const;
  bool may_be(const KinectBody& body, const Vec3& place, std::int64_t ticks) const;
  void follow(const KinectFrame& frame, const KinectBody& body);

  std::optional<std::uint64_t> wanted_;
  std::optional<std::uint32_t> session_;
  std::optional<std::uint64_t> last_;
  // The last position of the body, m; at first the position of the sensor.
  Vec3 place_ = Vec3::Zero();
  // The time of that position in ticks of the device; empty if not seen in this session.
  std::optional<std::int64_t> seen_;
  // ids_: all ids, for the report. others_: the ids of bodies seen apart from the person.
  std::set<std::uint64_t> ids_, others_;
  // Counts of frames with several bodies, of changes of the followed id, and of frames with other
  // bodies only.
  std::uint64_t several_ = 0, followed_ = 0, without_ = 0;
};

}  // namespace kinalign
