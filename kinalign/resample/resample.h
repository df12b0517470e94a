// SPDX-License-Identifier: Apache-2.0
// Resamples streams to the stamps of a grid (HFUT-MMD paper, section 3.2). Positions use natural
// cubic splines on the true stamps; rotations use splines on the rotation group. Gaps are not
// interpolated: their rows are invalid and zero. Splines end at gaps and use only samples that were
// seen.
#pragma once

#include "kinalign/motion/interpolation/rotation_spline.h"
#include "kinalign/motion/interpolation/spline.h"
#include "kinalign/resample/coarse_grid.h"
#include "kinalign/resample/window.h"
#include "kinalign/take/take.h"

#include <algorithm>
#include <cstdint>
#include <span>

namespace kinalign {

/// Number of knots on either side of a row that influence its value. Samples farther away do not
/// change the row, so the window drops them.
constexpr std::size_t knots_felt = std::max(spline_reach, rotation_spline_reach);

enum class RotationCurve { spline, slerp };

/// The parameters for resampling a stream. step_ns is used to find missing samples between two
/// samples; gap_ns is the longest time that is interpolated.
struct ResampleRule {
  std::int64_t gap_ns = 0;   // longer times without samples are gaps
  std::int64_t step_ns = 0;  // nominal step, or else the stream's median step
  TakenStep taken;           // the step at which the device took its samples
  RotationCurve curve = RotationCurve::spline;
  std::int64_t begin_ns = 0, end_ns = 0;  // time span of the take, in which gaps are counted
  bool finer = false;  // the stream's step is shorter than the grid's: measure the lost motion

  GapCount gap_count() const { return {gap_ns, begin_ns, end_ns}; }
  double rate_hz() const { return step_ns > 0 ? 1e9 / static_cast<double>(step_ns) : 0.0; }
  Reach reach() const { return {knots_felt, gap_ns}; }
};

/// The motion that is too fast for the grid, summed over all calls. Empty unless the rule's `finer`
/// is set.
struct ResampleCount {
  std::vector<CarriedContent> positions;                       // [J]
  std::vector<CarriedContent> acceleration, angular_velocity;  // [S]
};

/// For each row of a grid, the neighbouring samples of a stream with rising stamps. `left` gives
/// the sample before a row inside the stream. `known_by` is also set for rows outside the stream.
struct Neighbours {
  std::vector<std::size_t> left;             // [n] index of the last sample at or before the row
  std::vector<std::size_t> known_by;         // the same; outside the stream, the nearest sample
  std::vector<std::int64_t> nearest_raw_ns;  // [n] at most farthest_nearest_ns
};
/// For rows outside the stream, `left` is stamps.size().
Neighbours find_neighbours(std::span<const std::int64_t> stamps,
                           std::span<const std::int64_t> grid);

/// Returns the half-width of each row's time interval, ns: that of the clock at the sample
/// `known_by`. Empty if the clock has no interval. `stamps`: the device's stamps of the samples.
std::vector<std::int64_t> intervals_at(const TimeModel& clock, std::span<const Time> stamps,
                                       const Neighbours& near);

/// The common part of the three resamplers. A stream is read once from its beginning, so the stamps
/// of the grid must rise from call to call.
template <class Frames>
class Resampler {
 public:
  const ResampleCount& content() const { return count_; }
  StreamCounts counts() const { return window_.counts(); }
  /// Call after the last rows. Reads on, so that the counts include all samples up to the take's
  /// end.
  Result<void> read_to_end() { return window_.move(rule_.end_ns, rule_.end_ns, rule_.reach()); }

 protected:
  /// `taken`: the device's step, which is needed to find late samples.
  Resampler(Pass<Frames> pass, const TimeModel& clock, const ResampleRule& rule, TakenStep taken)
      : window_(std::move(pass), clock, rule.gap_count(), taken), clock_(&clock), rule_(rule) {}

  Window<Frames> window_;
  const TimeModel* clock_;
  ResampleRule rule_;
  ResampleCount count_;
};

class PointResampler : public Resampler<PointFrames> {
 public:
  PointResampler(Pass<PointFrames> pass, const TimeModel& clock, const ResampleRule& rule)
      : Resampler(std::move(pass), clock, rule, rule.taken) {}

  /// Makes the rows at the grid's stamps (ns, rising also from call to call).
  Result<void> rows(std::span<const std::int64_t> grid, PointRows& out);
};

/// Resamples the nodes of one stream. All have the same stamps.
class ImuResampler : public Resampler<ImuSamples> {
 public:
  ImuResampler(Pass<ImuSamples> pass, const TimeModel& clock, const ResampleRule& rule,
               const ImuContent& content)
      : Resampler(std::move(pass), clock, rule, rule.taken), content_(content) {}

  /// If `to_world`, vectors are rotated into the world's axes before interpolation. In the axes of
  /// a rotating sensor, straight motion would appear curved.
  Result<void> rows(std::span<const std::int64_t> grid, bool to_world, ImuRows& out);

 private:
  ImuContent content_;
};

class ClipResampler : public Resampler<ClipFrames> {
 public:
  // The empty TakenStep means that late frames of a skeleton stream are not looked for.
  ClipResampler(Pass<ClipFrames> pass, const TimeModel& clock, const ResampleRule& rule)
      : Resampler(std::move(pass), clock, rule, {}) {}

  /// Computes everything except the global positions.
  Result<void> rows(std::span<const std::int64_t> grid, ClipRows& out);
};

}  // namespace kinalign
