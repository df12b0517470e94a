// SPDX-License-Identifier: Apache-2.0
// Lists the arrays of each type of frame block, for code that treats all types alike. Further
// functions remove, append and copy rows of a window. Windows are short, so moving the remaining
// rows costs little, and spans over a window stay possible.
#pragma once

#include "kinalign/motion/clip.h"
#include "kinalign/motion/streams.h"

#include <cstddef>
#include <tuple>
#include <vector>

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
  // A quantity that a stream does not have is an empty array. Callers see this from its size.
  std::apply([&use](auto... array) { (use(array), ...); }, frame_arrays<Frames>);
}

/// Removes the first `count` values.
template <class T>
void erase_first(std::vector<T>& all, std::size_t count) {
  all.erase(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
}

template <class T>
void append_to(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// A copy of one row of `width` values.
template <class T>
std::vector<T> row_of(const std::vector<T>& all, std::size_t row, std::size_t width) {
  const auto begin = all.begin() + static_cast<std::ptrdiff_t>(row * width);
  return {begin, begin + static_cast<std::ptrdiff_t>(width)};
}

}  // namespace kinalign
