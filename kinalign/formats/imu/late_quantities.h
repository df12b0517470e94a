// SPDX-License-Identifier: Apache-2.0
// Quantities of nodes that begin behind the rows by which a file's content was settled.
#pragma once

#include "kinalign/motion/streams.h"

#include <cstdint>
#include <string>

namespace kinalign {

inline bool is_any(const ImuContent& content) {
  return content.orientation || content.acceleration || content.angular_velocity;
}

class LateQuantities {
 public:
  /// `here` has values in a row; `read` is the content that was settled.
  void add(const ImuContent& here, const ImuContent& read) {
    const bool turn = here.orientation && !read.orientation,
               force = here.acceleration && !read.acceleration,
               rate = here.angular_velocity && !read.angular_velocity;
    rows_ += turn || force || rate ? 1 : 0;
    what_.orientation |= turn;
    what_.acceleration |= force;
    what_.angular_velocity |= rate;
  }

  /// How many rows had one.
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
