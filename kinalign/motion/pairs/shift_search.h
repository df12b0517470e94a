// SPDX-License-Identifier: Apache-2.0
// Finds the time shift between two recordings of the same motion without a common clock. It is a
// full search over shifts; the cost is the rms of the rigid fit over the overlap (UI-PRMD's
// protocol).
#pragma once

#include "kinalign/motion/rigid_fit.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kinalign {

/// F frames of J points at a fixed rate.
/// Frame i is at the time i / rate_hz from the first one.
struct PointPiece {
  std::span<const double> positions;    // [F,J,3] m
  std::span<const std::uint8_t> valid;  // [F,J]; empty: all points are valid
  std::size_t joints = 0;
  double rate_hz = 0.0;

  std::size_t frames() const { return positions.size() / 3 / joints; }
  double seconds() const { return (static_cast<double>(frames()) - 1.0) / rate_hz; }
};

/// The points of a curve at the stamps of another recording.
struct CurvePoints {
  std::vector<double> positions;    // [F,J,3] m; zeros outside the curve's piece
  std::vector<std::uint8_t> valid;  // [F,J] 1 if both samples around the stamp are valid
};

/// A natural cubic spline through a piece. Invalid points also need a position, for example an
/// interpolated one. The arrays of the piece must outlive the curve.
/// The knots are numbered, so a place on the curve is a time multiplied by the rate.
class PieceCurve {
 public:
  explicit PieceCurve(const PointPiece& piece);

  /// The points at the times shift_s + i / rate_hz of the piece, i in [0, frames).
  CurvePoints at(double shift_s, double rate_hz, std::size_t frames) const;
  const PointPiece& piece() const { return piece_; }

 private:
  PointPiece piece_;
  std::vector<double> numbers_;  // [F] 0, 1, 2, …: positions of the knots
  std::vector<double> bends_;
};

/// The first search visits all shifts with enough overlap in coarse steps. The second one refines
/// the best of them.
struct ShiftOptions {
  double least_overlap = 0.8;  // share of the shorter piece
  double first_step_s = 1.0 / 30.0;
  /// Step of the second search, which covers three steps to each side of the best shift so far.
  double last_step_s = 0.01;
};

struct FoundShift {
  double shift_s = 0.0;  // s; frame i of `rough` is at time shift_s + i / rate of the curve
  double rms_m = 0.0;    // rms of the rigid fit of the curve to `rough` over the valid points
};

/// The shift with the least rms. Absent if at every shift fewer than five frames of valid points
/// overlap. All points of `rough` count as valid.
std::optional<FoundShift> find_shift(const PointPiece& rough, const PieceCurve& precise,
                                     const ShiftOptions& options = {});

/// Adds the pairs of valid points at a shift, from the curve to `rough`.
void add_pairs_at(const PointPiece& rough, const PieceCurve& precise, double shift_s,
                  PairMoments& moments);

}  // namespace kinalign
