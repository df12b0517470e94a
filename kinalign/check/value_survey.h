// SPDX-License-Identifier: Apache-2.0
// Statistics of a stream's values, computed in the pass that surveys its stamps. They reveal a
// wrong unit, orientations of another node, and streams with hardly any valid data. BVH files are
// judged by their rest pose instead (formats/bvh/size.cpp).
#pragma once

#include "kinalign/check/orientation_sense.h"
#include "kinalign/core/error.h"
#include "kinalign/formats/reader.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace kinalign {

/// The mean and the standard deviation of sizes, computed from sums.
struct MeanSize {
  std::uint64_t count = 0;
  double sum = 0.0, squares = 0.0;

  void add(double size);
  double mean() const { return sum / static_cast<double>(count); }
  double deviation() const;
};

/// Sums over the points of a stream; memory does not grow with the file. Frames whose points span
/// more than 20 m are counted separately, because a number that means "not seen" would falsify the
/// mean.
class PointSizes {
 public:
  void add(const PointFrames& block);
  /// Returns findings about these faults: the points of a frame are too far apart for a person or,
  /// with ten or more points, too close together; hardly any frame has a point; points are at
  /// exactly 0, 0, 0 or far away in some frames, as writers mark unseen points.
  Findings judge(const PointHeader& header, const std::string& file) const;

 private:
  /// The positions of a joint in the frames in which it was seen.
  struct Seen {
    bool elsewhere = false;          // the joint was once at another position than zero
    bool far = false;                // its last position other than zero was far from zero
    std::uint64_t now_at_zero = 0;   // frames at zero since then
    std::uint64_t lost_at_zero = 0;  // earlier frames at zero, before or after a far position

    void add(const Vec3& at);
    bool seen() const { return elsewhere || now_at_zero > 0; }
    std::uint64_t lost() const { return lost_at_zero + (far ? now_at_zero : 0); }
  };

  void judge_seen(const PointHeader& header, FileFindings& out) const;
  void judge_marks(const PointHeader& header, FileFindings& out) const;
  void judge_unit(FileFindings& out) const;

  std::uint64_t all_frames_ = 0, seen_frames_ = 0;
  std::uint64_t inferred_ = 0, tracked_ = 0;  // numbers of inferred and tracked points
  MeanSize person_, far_;  // m; diagonals of boxes around a frame's points: up to 20 m, and more
  std::uint64_t most_points_ = 0;  // greatest number of points seen in one frame
  std::vector<Seen> joints_;
};

/// Sums over the samples of all nodes of a stream. Only lengths of vectors are used, because they
/// do not depend on how a node is worn.
class ImuSizes {
 public:
  void add(const ImuSamples& block);
  /// Returns findings about these faults: accelerations can't be m/s2 with (or without) gravity,
  /// rates can't be rad/s, orientations do not belong to the node, or hardly any sample is valid.
  Findings judge(const ImuHeader& header, const std::string& file) const;

 private:
  static void add(std::span<const double> vectors, const ImuSamples& block, MeanSize& lengths);

  MeanSize acceleration_, angular_velocity_;
  OrientationSense orientation_;
  std::uint64_t samples_ = 0, valid_ = 0;
};

/// A skeleton is judged by its rest pose when it is read, which shows more than its frames.
struct ClipSizes {
  void add(const ClipFrames&) {}
  Findings judge(const Skeleton&, const std::string&) const { return {}; }
};

/// Returns the statistics for each kind of frames.
inline PointSizes sizes_of(const PointFrames&) { return {}; }
inline ImuSizes sizes_of(const ImuSamples&) { return {}; }
inline ClipSizes sizes_of(const ClipFrames&) { return {}; }

}  // namespace kinalign
