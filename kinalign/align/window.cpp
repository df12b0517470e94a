// SPDX-License-Identifier: Apache-2.0
#include "kinalign/align/window.h"

namespace kinalign {

namespace {

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

void append_rows(ClipFrames& to, const ClipFrames& from, std::size_t first, std::size_t count) {
  const std::size_t rows = from.size();
  append(to.local_positions, from.local_positions, rows, first, count);
  append(to.local_rotations, from.local_rotations, rows, first, count);
  append(to.stamps, from.stamps, rows, first, count);
}

void append_rows(PointFrames& to, const PointFrames& from, std::size_t first, std::size_t count) {
  const std::size_t rows = from.size();
  append(to.positions, from.positions, rows, first, count);
  append(to.state, from.state, rows, first, count);
  append(to.stamps, from.stamps, rows, first, count);
}

void append_rows(ImuSamples& to, const ImuSamples& from, std::size_t first, std::size_t count) {
  const std::size_t rows = from.size();
  append(to.orientation, from.orientation, rows, first, count);
  append(to.acceleration, from.acceleration, rows, first, count);
  append(to.angular_velocity, from.angular_velocity, rows, first, count);
  append(to.valid, from.valid, rows, first, count);
  append(to.stamps, from.stamps, rows, first, count);
}

void drop_front(ClipFrames& rows, std::size_t count) {
  if (count == 0) return;
  const std::size_t all = rows.size();
  drop(rows.local_positions, all, count);
  drop(rows.local_rotations, all, count);
  drop(rows.stamps, all, count);
}

void drop_front(PointFrames& rows, std::size_t count) {
  if (count == 0) return;
  const std::size_t all = rows.size();
  drop(rows.positions, all, count);
  drop(rows.state, all, count);
  drop(rows.stamps, all, count);
}

void drop_front(ImuSamples& rows, std::size_t count) {
  if (count == 0) return;
  const std::size_t all = rows.size();
  drop(rows.orientation, all, count);
  drop(rows.acceleration, all, count);
  drop(rows.angular_velocity, all, count);
  drop(rows.valid, all, count);
  drop(rows.stamps, all, count);
}

void drop_last(ClipFrames& rows) {
  const std::size_t all = rows.size();
  drop_back(rows.local_positions, all);
  drop_back(rows.local_rotations, all);
  drop_back(rows.stamps, all);
}

void drop_last(PointFrames& rows) {
  const std::size_t all = rows.size();
  drop_back(rows.positions, all);
  drop_back(rows.state, all);
  drop_back(rows.stamps, all);
}

void drop_last(ImuSamples& rows) {
  const std::size_t all = rows.size();
  drop_back(rows.orientation, all);
  drop_back(rows.acceleration, all);
  drop_back(rows.angular_velocity, all);
  drop_back(rows.valid, all);
  drop_back(rows.stamps, all);
}

}  // namespace kinalign
