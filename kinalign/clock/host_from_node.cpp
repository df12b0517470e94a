// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/host_from_node.h"

#include "kinalign/clock/bound.h"

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

struct Offset {
  double likeliest = 0.0, least = 0.0, greatest = 0.0;  // ns
};

Offset at_knot(const ClockKnot& knot) {
  return {static_cast<double>(knot.offset.count()), static_cast<double>(knot.least.count()),
          static_cast<double>(knot.greatest.count())};
}

/// Straight between knots; outside, the interval opens as fast as the rate may be off.
Offset offset_at(const ClockPieceModel& piece, NodeTime n) {
  const auto behind =
      std::upper_bound(piece.knots.begin(), piece.knots.end(), n,
                       [](NodeTime t, const ClockKnot& knot) { return t < knot.node; });
  if (behind == piece.knots.begin() || behind == piece.knots.end()) {
    const ClockKnot& end = behind == piece.knots.begin() ? piece.knots.front() : piece.knots.back();
    Offset offset = at_knot(end);
    const double open =
        piece.assumptions.rate * std::abs(static_cast<double>((n - end.node).count()));
    offset.least -= open;
    offset.greatest += open;
    return offset;
  }
  const Offset a = at_knot(*(behind - 1)), b = at_knot(*behind);
  const double share = static_cast<double>((n - (behind - 1)->node).count()) /
                       static_cast<double>((behind->node - (behind - 1)->node).count());
  return {std::lerp(a.likeliest, b.likeliest, share), std::lerp(a.least, b.least, share),
          std::lerp(a.greatest, b.greatest, share)};
}

HostTime on_host(NodeTime n, double offset_ns) {
  return HostTime{n.time_since_epoch() + Duration{static_cast<std::int64_t>(offset_ns)}};
}

}  // namespace

bool is_in(std::span<const DoubtfulStretch> doubtful, HostTime h) {
  const auto behind = std::upper_bound(
      doubtful.begin(), doubtful.end(), h,
      [](HostTime t, const DoubtfulStretch& stretch) { return t < stretch.begin; });
  return behind != doubtful.begin() && h <= (behind - 1)->end;
}

std::optional<ClockStamp> host_from_node(const HostFromNode& model, BootKey boot, NodeTime n,
                                         HostTime h_rx) {
  const auto piece = std::find_if(model.pieces.begin(), model.pieces.end(), [&](const auto& p) {
    return p.boot == boot && p.first <= h_rx && h_rx <= p.last;
  });
  if (piece == model.pieces.end() || piece->knots.empty()) return std::nullopt;
  const Offset offset = offset_at(*piece, n);
  ClockStamp stamp;
  stamp.assumptions = piece->assumptions;
  stamp.time = on_host(n, std::round(offset.likeliest)) + counter_resolution / 2;
  if (piece->certified) {
    stamp.certainty = Certainty::certified;
    stamp.earliest = on_host(n, std::floor(offset.least));
    stamp.latest = on_host(n, std::ceil(offset.greatest)) + counter_resolution;
    if (!is_behind_step(*stamp.earliest, piece->certified_from, h_rx))
      stamp.certainty = Certainty::doubtful;
  }
  if (is_in(model.doubtful, h_rx)) stamp.certainty = Certainty::doubtful;
  return stamp;
}

}  // namespace kinalign
