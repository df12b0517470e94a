// SPDX-License-Identifier: Apache-2.0
// Finds the recorded person among the bodies that a Kinect sees. The SDK gives a body a new id
// after it has lost it. Other people in view have ids too.
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
/// its last position continues, unless it was seen apart from the person before, since it is
/// somebody else then.
class KinectPerson {
 public:
  /// `wanted`: if given, only this id is used.
  explicit KinectPerson(std::optional<std::uint64_t> wanted) : wanted_(wanted) {}

  /// The id to take from the next frame. Absent if the person is not in it.
  std::optional<std::uint64_t> operator()(const KinectFrame& frame);

  void report(const std::string& file, Findings& findings) const;

 private:
  // The body of the frame to follow; nullptr: none of them may be the person.
  const KinectBody* body_in(const KinectFrame& frame) const;
  bool may_be(const KinectBody& body, const Vec3& place, std::int64_t ticks) const;
  void follow(const KinectFrame& frame, const KinectBody& body);

  std::optional<std::uint64_t> wanted_;
  std::optional<std::uint32_t> session_;
  std::optional<std::uint64_t> last_;
  // position of the body when it was last seen; at first that of the sensor
  Vec3 place_ = Vec3::Zero();
  // time of that, device ticks; absent: not seen in this session
  std::optional<std::int64_t> seen_;
  // All ids that were seen, for the report, and those that were seen apart from the person.
  std::set<std::uint64_t> ids_, others_;
  // Frames with several bodies; changes of the followed id; frames with others only.
  std::uint64_t several_ = 0, followed_ = 0, without_ = 0;
};

}  // namespace kinalign
