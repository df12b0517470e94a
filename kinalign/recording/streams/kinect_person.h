// SPDX-License-Identifier: Apache-2.0
// Which of the bodies that a Kinect sees is the recorded person. The SDK gives a body another id
// when it has lost it; anybody else in view has one, too.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/motion/arrays.h"
#include "kinalign/protocols/kinect/message.h"

#include <cstdint>
#include <optional>
#include <set>
#include <string>

namespace kinalign {

/// Begins with the body nearest to the sensor and follows its id. When that is gone, a body near to
/// where it was goes on, unless it stood beside it before: that one is somebody else.
class KinectPerson {
 public:
  /// `wanted`: an id, which alone is taken.
  explicit KinectPerson(std::optional<std::uint64_t> wanted) : wanted_(wanted) {}

  /// The id to take from the next frame; absent where the person isn't in it.
  std::optional<std::uint64_t> operator()(const KinectFrame& frame);

  void report(const std::string& file, Findings& findings) const;

 private:
  const KinectBody* body_in(const KinectFrame& frame) const;
  bool may_be(const KinectBody& body, const Vec3& place, std::int64_t ticks) const;
  void follow(const KinectFrame& frame, const KinectBody& body);

  std::optional<std::uint64_t> wanted_;
  std::optional<std::uint32_t> session_;
  std::optional<std::uint64_t> last_;
  Vec3 place_ = Vec3::Zero();         // of the body when it was seen last; at first the sensor's
  std::optional<std::int64_t> seen_;  // then, device ticks; absent: not in this session
  std::set<std::uint64_t> ids_, others_;
  std::uint64_t several_ = 0, followed_ = 0, without_ = 0;
};

}  // namespace kinalign
