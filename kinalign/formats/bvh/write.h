// SPDX-License-Identifier: Apache-2.0
// Writing a BVH block by block, its number of frames known before the first.
#pragma once

#include "kinalign/formats/bvh/bvh.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace kinalign {

class BvhWriter {
 public:
  BvhWriter(const BvhHierarchy& hierarchy, std::uint64_t frames, int decimals, TextSink sink);

  /// The next rows of channel values [n,C].
  Result<void> append(std::span<const double> values);
  /// Fails where other than the promised frames were given.
  Result<void> finish();

 private:
  TextSink sink_;
  std::size_t row_size_;
  int decimals_;
  std::uint64_t frames_, written_ = 0;
  std::string text_;  // not yet handed on
};

/// Channels for a clip made elsewhere: centimetres, y up, rotations Z X Y, six decimals; position
/// channels for roots and for joints that leave their offset by more than a micrometre, or for all
/// joints, as suits write them. Joints come in the order in which a BVH nests them.
class BvhChannels {
 public:
  enum class Positions { of_what_moves, of_all };
  explicit BvhChannels(const Skeleton& skeleton, Positions positions = Positions::of_what_moves);

  /// All frames' local positions [n,J,3], in blocks: which joints move.
  void see(std::span<const double> local_positions);
  BvhHierarchy hierarchy(std::uint64_t frames, double frame_seconds) const;

  /// Then their values: local positions [n,J,3] and rotations [n,J,4] become rows [n,C], appended.
  void append(std::span<const double> local_positions, std::span<const double> local_rotations,
              std::vector<double>& values) const;

 private:
  bool has_position(std::size_t j) const { return moves_[j] || skeleton_.parents[j] < 0; }

  Skeleton skeleton_;
  std::vector<std::size_t> order_;  // [J] the skeleton's joints as they are written
  std::vector<bool> moves_;         // [J]
};

}  // namespace kinalign
