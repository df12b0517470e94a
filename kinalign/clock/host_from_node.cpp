// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/host_from_node.h"

#include "kinalign/clock/bound.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

/// Offsets in whole nanoseconds. Each end is rounded outwards. A double can't hold an offset above
/// 104 days to a nanosecond.
struct Offset {
  Duration likeliest{}, least{}, greatest{};
};

double between(Duration a, Duration b, double share) {
  return static_cast<double>((b - a).count()) * share;
}

/// Interpolates linearly between knots. Before the first and after the last knot, the interval
/// widens at the greatest assumed rate.
Offset offset_at(const ClockPieceModel& piece, NodeTime n) {
  const auto behind =
      std::upper_bound(piece.knots.begin(), piece.knots.end(), n,
                       [](NodeTime t, const ClockKnot& knot) { return t < knot.node; });
  if (behind == piece.knots.begin() || behind == piece.knots.end()) {
    const ClockKnot& end = behind == piece.knots.begin() ? piece.knots.front() : piece.knots.back();
    const Duration open = nanoseconds(
        std::ceil(piece.assumptions.rate * std::abs(static_cast<double>((n - end.node).count()))));
    return {end.offset, end.least - open, end.greatest + open};
  }
  const ClockKnot &a = *(behind - 1), &b = *behind;
  const double share =
      static_cast<double>((n - a.node).count()) / static_cast<double>((b.node - a.node).count());
  return {a.offset + nanoseconds(std::round(between(a.offset, b.offset, share))),
          a.least + nanoseconds(std::floor(between(a.least, b.least, share))),
          a.greatest + nanoseconds(std::ceil(between(a.greatest, b.greatest, share)))};
}

HostTime on_host(NodeTime n, Duration offset) { return HostTime{n.time_since_epoch() + offset}; }

}  // namespace

bool is_in(std::span<const DoubtfulStretch> doubtful, HostTime h) {
  const auto behind = std::upper_bound(
      doubtful.begin(), doubtful.end(), h,
      [](HostTime t, const DoubtfulStretch& stretch) { return t < stretch.begin; });
  return behind != doubtful.begin() && h <= (behind - 1)->end;
}

/// The arrival selects the piece, since a reading may occur in several pieces.
std::optional<ClockStamp> host_from_node(const HostFromNode& model, BootKey boot, NodeTime n,
                                         HostTime h_rx) {
  const auto piece = std::find_if(model.pieces.begin(), model.pieces.end(), [&](const auto& p) {
    return p.boot == boot && p.first <= h_rx && h_rx <= p.last;
  });
  if (piece == model.pieces.end() || piece->knots.empty()) return std::nullopt;
  const Offset offset = offset_at(*piece, n);
  ClockStamp stamp;
  stamp.assumptions = piece->assumptions;
  stamp.time = on_host(n, offset.likeliest) + counter_resolution / 2;
  if (piece->certified) {
    stamp.certainty = Certainty::certified;
    stamp.earliest = on_host(n, offset.least);
    stamp.latest = on_host(n, offset.greatest) + counter_resolution;
    if (!is_behind_step(*stamp.earliest, piece->certified_from, h_rx))
      stamp.certainty = Certainty::doubtful;
  }
  if (is_in(model.doubtful, h_rx)) stamp.certainty = Certainty::doubtful;
  return stamp;
}

}  // namespace kinalign
