// SPDX-License-Identifier: Apache-2.0
// The time shift between two recordings of one motion that have no common clock: a full search over
// shifts, where the cost is the rms of the rigid fit over the overlap (UI-PRMD's protocol).
#pragma once

#include "kinalign/motion/rigid_fit.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kinalign {

/// F frames of J points at a fixed rate.
struct PointPiece {
  std::span<const double> positions;    // [F,J,3] m
  std::span<const std::uint8_t> valid;  // [F,J]; empty: all are
  std::size_t joints = 0;
  double rate_hz = 0.0;

  std::size_t frames() const { return positions.size() / 3 / joints; }
  double seconds() const { return (static_cast<double>(frames()) - 1.0) / rate_hz; }
};

/// Points at stamps of another piece.
struct CurvePoints {
  std::vector<double> positions;    // [F,J,3] m; zeros outside the curve's piece
  std::vector<std::uint8_t> valid;  // [F,J] both samples around the stamp are valid
};

/// A natural cubic spline through a piece whose points all have a place, the invalid ones a guessed
/// one. The piece's arrays must outlive it.
class PieceCurve {
 public:
  explicit PieceCurve(const PointPiece& piece);

  /// The points at the piece's own times shift_s + i / rate_hz, i in [0, frames).
  CurvePoints at(double shift_s, double rate_hz, std::size_t frames) const;
  const PointPiece& piece() const { return piece_; }

 private:
  PointPiece piece_;
  std::vector<double> numbers_;  // [F] 0, 1, 2, …: the knots' places
  std::vector<double> bends_;
};

struct ShiftOptions {
  double least_overlap = 0.8;  // of the shorter piece
  double first_step_s = 1.0 / 30.0;
  double last_step_s = 0.01;  // within three such steps around the best of the first search
};

struct FoundShift {
  double shift_s = 0.0;  // frame i of `rough` belongs to time shift_s + i / rate of the curve
  double rms_m = 0.0;    // of the rigid fit of curve onto rough over the valid points
};

/// The shift with the least rms. Absent where fewer than five frames of valid points overlap at
/// every shift. All points of `rough` count as valid.
std::optional<FoundShift> find_shift(const PointPiece& rough, const PieceCurve& precise,
                                     const ShiftOptions& options = {});

/// Adds the pairs of valid points, from the curve to `rough`, at a shift.
void add_pairs_at(const PointPiece& rough, const PieceCurve& precise, double shift_s,
                  PairMoments& moments);

}  // namespace kinalign
