// SPDX-License-Identifier: Apache-2.0
// Lists the arrays of each type of frame blocks, for code that treats all of them alike.
#pragma once

#include "kinalign/motion/clip.h"
#include "kinalign/motion/streams.h"

#include <tuple>

namespace kinalign {

/// The members of Frames that are arrays with one row per frame.
template <class Frames>
constexpr std::tuple<> frame_arrays;
template <>
inline constexpr auto frame_arrays<ClipFrames> = std::tuple(&ClipFrames::stamps,
                                                            &ClipFrames::local_positions,
                                                            &ClipFrames::local_rotations);
template <>
inline constexpr auto frame_arrays<PointFrames> = std::tuple(&PointFrames::stamps,
                                                             &PointFrames::positions,
                                                             &PointFrames::state);
template <>
inline constexpr auto frame_arrays<ImuSamples> = std::tuple(&ImuSamples::stamps,
                                                            &ImuSamples::orientation,
                                                            &ImuSamples::acceleration,
                                                            &ImuSamples::angular_velocity,
                                                            &ImuSamples::valid);

/// Calls use(member) for each array.
template <class Frames, class Use>
void for_each_frame_array(Use&& use) {
  // A quantity that a stream does not have is an empty array; users skip it by its size.
  std::apply([&use](auto... array) { (use(array), ...); }, frame_arrays<Frames>);
}

}  // namespace kinalign
