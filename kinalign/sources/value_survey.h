// SPDX-License-Identifier: Apache-2.0
// What a stream's values are like, from the pass that surveys its stamps: enough to see a unit that
// can't be right, orientations that belong to another node, and that hardly anything can be used.
// BVHs are judged by their rest pose instead (formats/bvh/size.cpp).
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/formats/reader.h"
#include "kinalign/sources/orientation_sense.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace kinalign {

class PointSizes {
 public:
  void add(const PointFrames& block);
  /// Findings where the points of a frame lie too far apart for a person or, where ten or more
  /// were seen, too near, where hardly a frame has any, and where a point now and then is at
  /// exactly 0, 0, 0 or far from all others, as writers mark what they did not see.
  Findings judge(const PointHeader& header, const std::string& file) const;

 private:
  /// Frames with two points or more, and the diagonals of the boxes around these.
  struct Frames {
    std::uint64_t count = 0;
    double diagonals_m = 0.0;  // their sum
  };
  /// Where a joint was in the frames in which it was seen.
  struct Seen {
    bool elsewhere = false;          // than at zero
    bool far = false;                // its last place elsewhere was
    std::uint64_t now_at_zero = 0;   // since then
    std::uint64_t lost_at_zero = 0;  // before, with a place far away in front or behind

    void add(const Vec3& at);
    bool seen() const { return elsewhere || now_at_zero > 0; }
    std::uint64_t lost() const { return lost_at_zero + (far ? now_at_zero : 0); }
  };

  Findings judge_seen(const PointHeader& header, const std::string& file) const;
  Findings judge_marks(const PointHeader& header, const std::string& file) const;
  Findings judge_unit(const std::string& file) const;

  std::uint64_t all_frames_ = 0, seen_frames_ = 0;
  std::uint64_t inferred_ = 0, tracked_ = 0;  // points
  Frames person_, far_;                       // up to 20 m, and beyond
  std::uint64_t most_points_ = 0;             // in one of them
  std::vector<Seen> joints_;
};

class ImuSizes {
 public:
  void add(const ImuSamples& block);
  /// Findings where accelerations can't be m/s2 with (or without) gravity, rates not rad/s,
  /// orientations not those of the same node, or where hardly a sample is valid.
  Findings judge(const ImuHeader& header, const std::string& file) const;

 private:
  struct Norms {
    std::uint64_t count = 0;
    double sum = 0.0, squares = 0.0;

    double mean() const { return sum / static_cast<double>(count); }
    double deviation() const;
  };
  static void add(std::span<const double> vectors, const ImuSamples& block, Norms& norms);

  Norms acceleration_, angular_velocity_;
  OrientationSense orientation_;
  std::uint64_t samples_ = 0, valid_ = 0;
};

/// A skeleton's rest pose says more than its frames do: it is judged where it is read.
struct ClipSizes {
  void add(const ClipFrames&) {}
  Findings judge(const Skeleton&, const std::string&) const { return {}; }
};

/// The sizes to take of frames of a kind.
inline PointSizes sizes_of(const PointFrames&) { return {}; }
inline ImuSizes sizes_of(const ImuSamples&) { return {}; }
inline ClipSizes sizes_of(const ClipFrames&) { return {}; }

}  // namespace kinalign
