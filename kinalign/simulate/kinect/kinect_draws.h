// SPDX-License-Identifier: Apache-2.0
// The random number streams of a simulated Kinect. Each random quantity has its own stream for each
// person, take or camera to which it belongs.
#pragma once

#include "kinalign/simulate/kinect/kinect_camera.h"
#include "kinalign/simulate/random.h"

namespace kinalign {

/// The numbers are part of the streams' seeds. Add new quantities at the end, because otherwise the
/// draws of later ones change.
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

/// The stream of a person: the same in all takes and for all cameras.
inline RandomStream kinect_person_stream(KinectDraw draw, const KinectIds& ids) {
  return {ids.seed, mix64(mix64(0x4B32 + static_cast<std::uint64_t>(draw)) ^ ids.person)};
}
/// The stream of one take of one person: the same for all cameras.
inline RandomStream kinect_take_stream(KinectDraw draw, const KinectIds& ids) {
  const std::uint64_t person =
      mix64(mix64(0x4B33 + 16 * static_cast<std::uint64_t>(draw)) ^ ids.person);
  return {ids.seed, mix64(person ^ ids.take)};
}
/// The stream of one take of one person for one camera.
inline RandomStream kinect_stream(KinectDraw draw, const KinectIds& ids) {
  const std::uint64_t person =
      mix64(mix64(0x4B34 + 256 * static_cast<std::uint64_t>(draw)) ^ ids.person);
  return {ids.seed, mix64(mix64(person ^ ids.take) ^ mix64(ids.camera))};
}

}  // namespace kinalign
