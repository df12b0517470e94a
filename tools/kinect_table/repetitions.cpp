// SPDX-License-Identifier: Apache-2.0
#include "tools/kinect_table/repetitions.h"

#include <bit>
#include <cstring>

namespace kinalign {

namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian");

constexpr std::string_view magic = "KAPAIRS1";

/// Takes values from the front of bytes while there are enough.
class Cursor {
 public:
  explicit Cursor(std::string_view bytes) : rest_(bytes) {}

  template <class T>
  bool take(std::size_t count, std::vector<T>& values) {
    if (rest_.size() / sizeof(T) < count) return false;
    values.resize(count);
    std::memcpy(values.data(), rest_.data(), count * sizeof(T));
    rest_.remove_prefix(count * sizeof(T));
    return true;
  }
  bool empty() const { return rest_.empty(); }

 private:
  std::string_view rest_;
};

bool take_places(Cursor& cursor, std::size_t count, std::vector<double>& places) {
  std::vector<float> values;
  if (!cursor.take(count, values)) return false;
  places.assign(values.begin(), values.end());
  return true;
}

bool take_piece(Cursor& cursor, Repetition& piece) {
  std::vector<std::uint32_t> head;
  if (!cursor.take(4, head)) return false;
  piece.person = head[0];
  piece.movement = head[1];
  piece.repetition = head[2];
  piece.frames = head[3];
  const std::size_t joints = piece.frames * mapped_joints;
  return take_places(cursor, 3 * joints, piece.kinect) &&
         take_places(cursor, 3 * joints, piece.truth) && cursor.take(joints, piece.valid);
}

}  // namespace

Result<std::vector<Repetition>> read_pieces(std::string_view bytes, std::string_view name) {
  const auto fails = [&](std::string_view expected, std::string found) {
    return Failure(Error{std::string(name), 0, std::string(expected), std::move(found)});
  };
  if (!bytes.starts_with(magic)) return fails("a file of export_ui_prmd.py", "another one");
  Cursor cursor(bytes.substr(magic.size()));
  std::vector<std::uint32_t> count;
  if (!cursor.take(1, count)) return fails("a number of pieces", "the end");
  std::vector<Repetition> pieces;
  for (std::uint32_t i = 0; i < count[0]; ++i) {
    if (!take_piece(cursor, pieces.emplace_back())) {
      return fails(std::to_string(count[0]) + " pieces", std::to_string(i));
    }
  }
  return pieces;
}

std::vector<TakeRange> takes(const std::vector<Repetition>& pieces) {
  std::vector<TakeRange> ranges;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const bool same = i > 0 && pieces[i].person == pieces[i - 1].person &&
                      pieces[i].movement == pieces[i - 1].movement;
    if (!same) ranges.push_back({i, i});
    ranges.back().end = i + 1;
  }
  return ranges;
}

}  // namespace kinalign
