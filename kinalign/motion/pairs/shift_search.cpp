// SPDX-License-Identifier: Apache-2.0
#include "kinalign/motion/pairs/shift_search.h"

#include "kinalign/motion/interpolation/spline.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace kinalign {

namespace {

constexpr double least_frames = 5.0;  // frames of valid points needed for a meaningful fit

std::vector<double> counted(std::size_t frames) {
  std::vector<double> out(frames);
  for (std::size_t i = 0; i < frames; ++i) out[i] = static_cast<double>(i);
  return out;
}

Knots knots_of(const PointPiece& piece, std::span<const double> numbers) {
  return {numbers, piece.positions, 3 * piece.joints};
}

void add_valid(const PointPiece& rough, const CurvePoints& points, PairMoments& moments) {
  for (std::size_t i = 0; i < points.valid.size(); ++i) {
    if (points.valid[i] == 0) continue;
    moments.add(vec3(points.positions, i), vec3(rough.positions, i));
  }
}

/// The rms of the rigid fit at a shift; absent if the overlap is too short.
std::optional<double> rms_at(const PointPiece& rough, const PieceCurve& precise, double shift_s) {
  const CurvePoints points = precise.at(shift_s, rough.rate_hz, rough.frames());
  PairMoments moments;
  add_valid(rough, points, moments);
  // A short overlap fits well by chance.
  if (static_cast<double>(moments.count) < least_frames * static_cast<double>(rough.joints)) {
    return std::nullopt;
  }
  // Points on one line have no rigid fit; such a shift is left out.
  const auto rough_from_precise = fit_rigid(moments);
  if (!rough_from_precise) return std::nullopt;
  double square = 0.0;
  for (std::size_t i = 0; i < points.valid.size(); ++i) {
    if (points.valid[i] == 0) continue;
    const Vec3 moved = *rough_from_precise * Vec3(vec3(points.positions, i));
    square += (moved - vec3(rough.positions, i)).squaredNorm();
  }
  return std::sqrt(square / static_cast<double>(moments.count));
}

/// The values of NumPy's arange, exact to the last bit. Rounding decides whether a frame at the
/// very end of the precise piece is inside, and one frame can decide between two shifts.
std::vector<double> arange(double start, double step, std::size_t count) {
  // NumPy takes the step from the first two values, which are rounded.
  const double exact_step = (start + step) - start;
  std::vector<double> out(count);
  for (std::size_t i = 0; i < count; ++i) out[i] = start + static_cast<double>(i) * exact_step;
  return out;
}

/// The shift with the least rms; the first one if several are equal.
std::optional<FoundShift> best_of(const PointPiece& rough, const PieceCurve& precise,
                                  std::span<const double> shifts) {
  std::optional<FoundShift> best;
  for (const double shift : shifts) {
    const auto rms = rms_at(rough, precise, shift);
    if (rms && (!best || *rms < best->rms_m)) best = {shift, *rms};
  }
  return best;
}

}  // namespace

PieceCurve::PieceCurve(const PointPiece& piece)
    : piece_(piece), numbers_(counted(piece.frames())), bends_(piece.positions.size()) {
  assert(piece.frames() > 0);
  natural_spline(knots_of(piece_, numbers_), bends_);
}

CurvePoints PieceCurve::at(double shift_s, double rate_hz, std::size_t frames) const {
  const std::size_t joints = piece_.joints;
  CurvePoints out{std::vector<double>(3 * frames * joints),
                  std::vector<std::uint8_t>(frames * joints)};
  std::vector<double> places;  // times of the frames within the piece, in samples of the piece
  std::size_t first = 0;       // the frame that belongs to places.front()
  for (std::size_t i = 0; i < frames; ++i) {
    const double s = (shift_s + static_cast<double>(i) / rate_hz) * piece_.rate_hz;
    // Times rise, so all later frames are outside, too.
    if (s > numbers_.back()) break;
    if (s < 0.0) continue;
    if (places.empty()) first = i;
    places.push_back(s);
  }
  if (places.empty()) return out;
  spline_at(knots_of(piece_, numbers_), bends_, places,
            std::span(out.positions).subspan(3 * first * joints, 3 * places.size() * joints));
  for (std::size_t i = 0; i < places.size(); ++i) {
    // The spline has a value everywhere. Next to an invalid sample that value is only a guess.
    const auto before = static_cast<std::size_t>(std::floor(places[i])) * joints;
    const auto behind = static_cast<std::size_t>(std::ceil(places[i])) * joints;
    for (std::size_t j = 0; j < joints; ++j) {
      const bool valid =
          piece_.valid.empty() || (piece_.valid[before + j] != 0 && piece_.valid[behind + j] != 0);
      out.valid[(first + i) * joints + j] = valid ? 1 : 0;
    }
  }
  return out;
}

std::optional<FoundShift> find_shift(const PointPiece& rough, const PieceCurve& precise,
                                     const ShiftOptions& options) {
  const double rough_s = rough.seconds(), precise_s = precise.piece().seconds();
  const double overlap = options.least_overlap * std::min(rough_s, precise_s);
  // A shift is negative if the rough piece begins before the precise one.
  const double from = overlap - rough_s, to = precise_s - overlap + 1e-9;
  const auto steps = static_cast<std::size_t>(std::ceil((to - from) / options.first_step_s));
  const auto best = best_of(rough, precise, arange(from, options.first_step_s, steps));
  if (!best) return std::nullopt;
  // The second search visits three steps on each side of the best shift.
  std::vector<double> fine = arange(-3.0 * options.last_step_s, options.last_step_s, 7);
  for (double& shift : fine) shift += best->shift_s;
  return best_of(rough, precise, fine);
}

void add_pairs_at(const PointPiece& rough, const PieceCurve& precise, double shift_s,
                  PairMoments& moments) {
  add_valid(rough, precise.at(shift_s, rough.rate_hz, rough.frames()), moments);
}

}  // namespace kinalign
