// SPDX-License-Identifier: Apache-2.0
// Counts rows with quantities that first appear after the rows by which a file's content was
// decided.
#pragma once

#include "kinalign/motion/streams.h"

#include <cstdint>
#include <string>

namespace kinalign {

inline bool is_any(const ImuContent& content) {
  return content.orientation || content.acceleration || content.angular_velocity;
}

/// Content is decided early, because the header must be known before the first row is passed on. A
/// quantity that begins later can't be added then.
class LateQuantities {
 public:
  /// Call for each row. `here`: the quantities with values in this row; `read`: those that are
  /// read.
  void add(const ImuContent& here, const ImuContent& read) {
    const bool turn = here.orientation && !read.orientation,
               force = here.acceleration && !read.acceleration,
               rate = here.angular_velocity && !read.angular_velocity;
    rows_ += turn || force || rate ? 1 : 0;
    what_.orientation |= turn;
    what_.acceleration |= force;
    what_.angular_velocity |= rate;
  }

  /// Number of rows with at least one such quantity.
  /// For the finding at the end of the file.
  std::uint64_t rows() const { return rows_; }

  /// "orientation, angular velocity"
  std::string names() const {
    std::string out;
    const auto name = [&out](bool late, const char* quantity) {
      if (late) out += (out.empty() ? "" : ", ") + std::string(quantity);
    };
    name(what_.orientation, "orientation");
    name(what_.acceleration, "acceleration");
    name(what_.angular_velocity, "angular velocity");
    return out;
  }

 private:
  std::uint64_t rows_ = 0;
  ImuContent what_;
};

}  // namespace kinalign
