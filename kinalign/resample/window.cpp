// SPDX-License-Identifier: Apache-2.0
#include "kinalign/resample/window.h"

#include "kinalign/motion/frame_arrays.h"

namespace kinalign {

namespace {

/// The width is 0 if the stream does not have the quantity. Blocks are never empty.
template <class T>
void append(std::vector<T>& to, const std::vector<T>& from, std::size_t rows, std::size_t first,
            std::size_t count) {
  const std::size_t width = from.size() / rows;
  const auto begin = from.begin() + static_cast<std::ptrdiff_t>(first * width);
  to.insert(to.end(), begin, begin + static_cast<std::ptrdiff_t>(count * width));
}

template <class T>
void drop(std::vector<T>& array, std::size_t rows, std::size_t count) {
  const std::size_t width = array.size() / rows;
  array.erase(array.begin(), array.begin() + static_cast<std::ptrdiff_t>(count * width));
}

template <class T>
void drop_back(std::vector<T>& array, std::size_t rows) {
  array.resize(array.size() - array.size() / rows);
}

}  // namespace

template <class Frames>
void append_rows(Frames& to, const Frames& from, std::size_t first, std::size_t count) {
  const std::size_t rows = from.size();
  for_each_frame_array<Frames>(
      [&](auto array) { append(to.*array, from.*array, rows, first, count); });
}

template <class Frames>
void drop_front(Frames& rows, std::size_t count) {
  const std::size_t all = rows.size();
  if (count > 0) for_each_frame_array<Frames>([&](auto array) { drop(rows.*array, all, count); });
}

template <class Frames>
void drop_last(Frames& rows) {
  const std::size_t all = rows.size();
  for_each_frame_array<Frames>([&](auto array) { drop_back(rows.*array, all); });
}

// Instantiated here for the three kinds of blocks, so that their code is not in window.h.
template void append_rows(ClipFrames&, const ClipFrames&, std::size_t, std::size_t);
template void append_rows(PointFrames&, const PointFrames&, std::size_t, std::size_t);
template void append_rows(ImuSamples&, const ImuSamples&, std::size_t, std::size_t);
template void drop_front(ClipFrames&, std::size_t);
template void drop_front(PointFrames&, std::size_t);
template void drop_front(ImuSamples&, std::size_t);
template void drop_last(ClipFrames&);
template void drop_last(PointFrames&);
template void drop_last(ImuSamples&);

}  // namespace kinalign
