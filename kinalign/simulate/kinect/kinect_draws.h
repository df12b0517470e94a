// SPDX-License-Identifier: Apache-2.0
// Streams of a simulated Kinect's random numbers: one for each quantity drawn, and for each person,
// take or camera to which it belongs.
#pragma once

#include "kinalign/simulate/kinect/kinect_camera.h"
#include "kinalign/simulate/random.h"

namespace kinalign {

/// The numbers are part of the streams' seeds: a new quantity goes to the end, or those after it
/// change.
enum class KinectDraw : std::uint8_t {
  stamps,
  person_bias,
  take_bias,
  camera_bias,
  yaw_bias,
  body_noise,
  camera_noise,
  white,
  twitches,
  occlusion,
  exchange,
  pose_noise,
  take_size
};

/// Stream of a person: the same in all takes and for all cameras.
inline RandomStream kinect_person_stream(KinectDraw draw, const KinectIds& ids) {
  return {ids.seed, mix64(mix64(0x4B32 + static_cast<std::uint64_t>(draw)) ^ ids.person)};
}
/// Random stream of one take of one person, the same for all cameras.
inline RandomStream kinect_take_stream(KinectDraw draw, const KinectIds& ids) {
  const std::uint64_t person =
      mix64(mix64(0x4B33 + 16 * static_cast<std::uint64_t>(draw)) ^ ids.person);
  return {ids.seed, mix64(person ^ ids.take)};
}
/// Stream of a take as one camera sees it.
inline RandomStream kinect_stream(KinectDraw draw, const KinectIds& ids) {
  const std::uint64_t person =
      mix64(mix64(0x4B34 + 256 * static_cast<std::uint64_t>(draw)) ^ ids.person);
  return {ids.seed, mix64(mix64(person ^ ids.take) ^ mix64(ids.camera))};
}

}  // namespace kinalign
