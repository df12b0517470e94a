// SPDX-License-Identifier: Apache-2.0
// The input of all metrics: a ground truth with its validity, and a method's prediction. The
// metrics are those of UI-PRMD's protocol and of docs/eval.md. Lengths are metres.
#pragma once

#include "kinalign/motion/arrays.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace kinalign {

/// T frames of J joints at a fixed rate, without gaps. The caller owns the arrays.
struct Sequence {
  std::size_t joints = 0;
  double rate_hz = 0.0;
  std::span<const double> truth;        // [T,J,3] m, y up
  std::span<const std::uint8_t> valid;  // [T,J] 0: the joint does not count in this frame

  std::size_t frames() const { return joints == 0 ? 0 : valid.size() / joints; }
  bool has(std::size_t frame, std::size_t joint) const {
    return valid[frame * joints + joint] != 0;
  }
};

/// The positions that a method predicts for every joint in every frame, [T,J,3] m.
using Prediction = std::span<const double>;

/// Indices of the two joints of a bone.
struct Bone {
  std::size_t a = 0, b = 0;
};

/// A running mean; absent if nothing was added. In a table an absent value is visible, whereas a 0
/// would look like a perfect result.
class Mean {
 public:
  void add(double value) {
    sum_ += value;
    ++count_;
  }
  void add(const Mean& more) {
    sum_ += more.sum_;
    count_ += more.count_;
  }
  std::size_t count() const { return count_; }
  std::optional<double> value() const {
    return count_ == 0 ? std::nullopt : std::optional(sum_ / static_cast<double>(count_));
  }
  double value_or(double other) const { return value().value_or(other); }

 private:
  double sum_ = 0.0;
  std::size_t count_ = 0;
};

}  // namespace kinalign
