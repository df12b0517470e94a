// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/streams/kinect_person.h"

#include <fmt/format.h>

#include <algorithm>

namespace kinalign {

namespace {

// This limits the memory, because a damaged recording may have a new id in every frame.
constexpr std::size_t most_ids = 1000;
// Both values are choices. A person moves by less than near_m while the SDK assigns a new id. In a
// lab, nobody walks faster than walk_m_per_s.
constexpr double near_m = 1.0, walk_m_per_s = 1.0;
constexpr double tick_s = 1e-7;

/// The mean position of the tracked joints; empty if no joint is tracked.
std::optional<Vec3> place_of(const KinectBody& body) {
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (std::size_t j = 0; j < body.states.size(); ++j) {
    const Vec3 at(body.positions[3 * j], body.positions[3 * j + 1], body.positions[3 * j + 2]);
    if (body.states[j] == 0 || !at.allFinite()) continue;
    sum += at;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return Vec3(sum / count);
}

}  // namespace

std::optional<std::uint64_t> KinectPerson::operator()(const KinectFrame& frame) {
  several_ += frame.bodies.size() > 1 ? 1 : 0;
  // All ids are kept even if the user selected one, because the report lists them.
  for (const KinectBody& body : frame.bodies) {
    if (ids_.size() < most_ids) ids_.insert(body.id);
  }
  if (wanted_) return wanted_;
  if (session_ != frame.origin.session) {  // a new session has other ids and ticks
    session_ = frame.origin.session;
    last_.reset();
    seen_.reset();
    others_.clear();
  }
  const KinectBody* body = body_in(frame);
  if (body == nullptr) {
    without_ += frame.bodies.empty() ? 0 : 1;
    return std::nullopt;
  }
  follow(frame, *body);
  return body->id;
}

/// The body with the followed id. Without this id: the nearest body that may be the person.
const KinectBody* KinectPerson::body_in(const KinectFrame& frame) const {
  const KinectBody* nearest = nullptr;
  double least = 0.0;
  for (const KinectBody& body : frame.bodies) {
    if (body.id == last_) return &body;
    const auto place = place_of(body);
    if (!place || !may_be(body, *place, frame.device_ticks)) continue;
    const double distance = (*place - place_).norm();
    if (nearest != nullptr && distance >= least) continue;
    nearest = &body;
    least = distance;
  }
  return nearest;
}

// The longer the person was not seen, the further away the person may be.
bool KinectPerson::may_be(const KinectBody& body, const Vec3& place, std::int64_t ticks) const {
  // Before the person is seen for the first time, any body may be the person. The caller takes the
  // body nearest to the sensor.
  if (!seen_) return true;
  const double lost_s = tick_s * static_cast<double>(std::max<std::int64_t>(0, ticks - *seen_));
  return !others_.contains(body.id) && (place - place_).norm() < near_m + walk_m_per_s * lost_s;
}

void KinectPerson::follow(const KinectFrame& frame, const KinectBody& body) {
  followed_ += body.id != last_ ? 1 : 0;
  last_ = body.id;
  seen_ = frame.device_ticks;
  // If the body has no tracked joints, the last position is kept.
  place_ = place_of(body).value_or(place_);
  for (const KinectBody& other : frame.bodies) {
    if (other.id == last_ || others_.size() >= most_ids) continue;
    // The SDK sometimes reports one person as two bodies at the same place. Such a body does not
    // count as another person.
    const auto place = place_of(other);
    if (place && (*place - place_).norm() > near_m / 2.0) others_.insert(other.id);
  }
}

/// Reports a missing id, changes of the id, other bodies, and frames without the person.
void KinectPerson::report(const std::string& file, Findings& findings) const {
  if (wanted_ && ids_.count(*wanted_) == 0) {
    findings.push_back(
        {Severity::warning,
         Error{file, 0, fmt::format("body {}", *wanted_), fmt::format("{} other ids", ids_.size())},
         "all joints are missing in all rows", "set select.body to an existing id"});
  }
  if (followed_ > 1) {
    findings.push_back(
        {Severity::note,
         Error{file, 0, "one body", fmt::format("{} ids, one after the other", followed_)},
         "the sensor lost the person and found a body with a new id nearby, which is followed",
         "select.body takes a single id"});
  }
  if (several_ > 0 && !wanted_) {
    findings.push_back(
        {Severity::warning,
         Error{file, 0, "one body", fmt::format("several bodies in {} frames", several_)},
         "the body that was nearest to the sensor at the beginning is followed",
         "set select.body to follow another body"});
  }
  if (without_ > 0) {
    findings.push_back({Severity::note,
                        Error{file, 0, "the followed person",
                              fmt::format("{} frames with only other bodies", without_)},
                        "all joints are missing in these frames", "select.body takes a single id"});
  }
}

}  // namespace kinalign
