// SPDX-License-Identifier: Apache-2.0
// Statistics of a stream's values, taken in the pass that surveys its stamps. They show a unit that
// can't be right, orientations of another node, and streams with hardly any valid data. BVHs are
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

/// The mean of sizes, without keeping them.
struct MeanSize {
  std::uint64_t count = 0;
  double sum = 0.0, squares = 0.0;

  void add(double size);
  double mean() const { return sum / static_cast<double>(count); }
  double deviation() const;
};

/// Sums over the points of a stream; memory does not grow with the file. Frames whose points span
/// more than 20 m are counted apart, since one number that means "not seen" would spoil a mean.
class PointSizes {
 public:
  void add(const PointFrames& block);
  /// Findings if the points of a frame lie too far apart for a person or, with ten or more points,
  /// too close together; if hardly a frame has a point; and if points are sometimes at exactly 0,
  /// 0, 0 or far from all others, as writers mark points that were not seen.
  Findings judge(const PointHeader& header, const std::string& file) const;

 private:
  /// The places of a joint in the frames in which it was seen.
  struct Seen {
    bool elsewhere = false;          // once at another place than zero
    bool far = false;                // its last place other than zero was far from zero
    std::uint64_t now_at_zero = 0;   // zeros since then
    std::uint64_t lost_at_zero = 0;  // earlier zeros with a far place before or after

    void add(const Vec3& at);
    bool seen() const { return elsewhere || now_at_zero > 0; }
    std::uint64_t lost() const { return lost_at_zero + (far ? now_at_zero : 0); }
  };

  void judge_seen(const PointHeader& header, FileFindings& out) const;
  void judge_marks(const PointHeader& header, FileFindings& out) const;
  void judge_unit(FileFindings& out) const;

  std::uint64_t all_frames_ = 0, seen_frames_ = 0;
  std::uint64_t inferred_ = 0, tracked_ = 0;  // counts of points
  MeanSize person_, far_;                     // diagonals of boxes around a frame's points, m:
                                              // up to 20 m, and more
  std::uint64_t most_points_ = 0;             // points seen in one frame, at most
  std::vector<Seen> joints_;
};

/// Sums over the samples of all nodes of a stream. Only lengths of vectors are kept, because they
/// do not depend on how a node is worn.
class ImuSizes {
 public:
  void add(const ImuSamples& block);
  /// Findings if accelerations can't be m/s2 with (or without) gravity, if rates can't be rad/s, if
  /// orientations are not those of the same node, or if hardly a sample is valid.
  Findings judge(const ImuHeader& header, const std::string& file) const;

 private:
  static void add(std::span<const double> vectors, const ImuSamples& block, MeanSize& lengths);

  MeanSize acceleration_, angular_velocity_;
  OrientationSense orientation_;
  std::uint64_t samples_ = 0, valid_ = 0;
};

/// A skeleton is judged by its rest pose where it is read; its frames show less.
struct ClipSizes {
  void add(const ClipFrames&) {}
  Findings judge(const Skeleton&, const std::string&) const { return {}; }
};

/// The statistics for each kind of frames.
inline PointSizes sizes_of(const PointFrames&) { return {}; }
inline ImuSizes sizes_of(const ImuSamples&) { return {}; }
inline ClipSizes sizes_of(const ClipFrames&) { return {}; }

}  // namespace kinalign
