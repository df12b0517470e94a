// SPDX-License-Identifier: Apache-2.0
// Second step of the offline clock: each piece found by the walk is fitted to all of its bounds.
#include "kinalign/clock/offline/offline_clock.h"

#include "kinalign/clock/bound.h"
#include "kinalign/clock/live/certificate.h"
#include "kinalign/clock/offline/offline_estimate.h"
#include "kinalign/clock/offline/offline_walk.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kinalign {

namespace {

constexpr double knot_s = 1.0;
constexpr double longest_wait_s = 60.0;    // longest delay of a packet
constexpr double longest_offline_s = 1e6;  // eleven days; there is a knot for each second

/// The bounds of a piece, in seconds from its first exchange.
struct PieceBounds {
  ClockOrigin origin;
  std::vector<Bound> bounds;
  std::uint64_t up = 0, down = 0;

  void add(Side side, NodeTime n, HostTime h) {
    bounds.push_back(bound_by(origin, side, n, h));
    ++(side == Side::above ? up : down);
  }
};

Certificate certificate_of(std::vector<Bound> bounds, const Assumptions& assumptions) {
  std::sort(bounds.begin(), bounds.end(),  // adding at the end is cheap, inserting is not
            [](const Bound& a, const Bound& b) { return a.s < b.s; });
  Certificate certificate(assumptions);
  for (const Bound& b : bounds) certificate.add(b);
  return certificate;
}

// The model of a piece before anything is said about its certainty.
struct Knots {
  std::vector<ClockKnot> knots;
  bool sound = true;  // the bounds agree everywhere and leave at least the least width
};

/// A knot a second, with the likeliest offset and the interval. The interval is widened for the
/// curvature between knots.
Knots knots_of(const PieceBounds& piece, const Certificate& certificate, OfflineEstimate& estimate,
               double least_width) {
  double begin = piece.bounds.front().s, end = begin;
  for (const Bound& b : piece.bounds) {
    begin = std::min(begin, b.s);
    end = std::max(end, b.s);
  }
  const double widened = certificate.assumptions().curvature * knot_s * knot_s / 8.0;
  // The offset between the origins is added in whole nanoseconds, which a double may not keep.
  const Duration base = piece.origin.host.time_since_epoch() - piece.origin.node.time_since_epoch();
  const auto count = static_cast<std::size_t>(std::ceil((end - begin) / knot_s)) + 1;
  Knots out;
  for (std::size_t i = 0; i < count; ++i) {
    const Duration since = nanoseconds(std::round((begin + knot_s * static_cast<double>(i)) * 1e9));
    const double t = seconds(since), likeliest = estimate.at(t);
    const auto range = certificate.at(t);
    // One knot at which the bounds contradict each other, or leave less room than packets take,
    // refutes the assumptions for the whole piece.
    out.sound = out.sound && range && range->high - range->low >= least_width;
    const double low = range ? range->low : likeliest, high = range ? range->high : likeliest;
    out.knots.push_back({piece.origin.node + since,
                         base + nanoseconds(std::round(std::clamp(likeliest, low, high) * 1e9)),
                         base + nanoseconds(std::floor((low - widened) * 1e9)),
                         base + nanoseconds(std::ceil((high + widened) * 1e9))});
  }
  return out;
}

/// Fits a piece under the assumptions that the live clock had for it. A piece that contradicts them
/// has no certificate.
void fit(const PieceBounds& piece, double least_width, const Assumptions& assumptions,
         ClockPieceModel& model) {
  OfflineEstimate estimate(piece.bounds);
  model.routes = estimate.routes();
  model.round_trip = nanoseconds(estimate.least_round_trip() * 1e9);
  model.assumptions = assumptions;
  const Certificate certificate = certificate_of(piece.bounds, assumptions);
  Knots found = knots_of(piece, certificate, estimate, least_width);
  model.knots = std::move(found.knots);
  model.certified = found.sound && certificate.bounded();
}

/// True if the counter advanced about as far as the host's clock. A piece of two frames has no
/// certificate that could exclude a faulty counter, and there would be a knot for each second of
/// it.
bool counted_like_the_host(const PieceBounds& piece) {
  const auto [first, last] =
      std::minmax_element(piece.bounds.begin(), piece.bounds.end(),
                          [](const Bound& a, const Bound& b) { return a.s < b.s; });
  const auto [least, most] =
      std::minmax_element(piece.bounds.begin(), piece.bounds.end(),
                          [](const Bound& a, const Bound& b) { return a.s + a.x < b.s + b.x; });
  const double host = most->s + most->x - least->s - least->x;
  const double node = last->s - first->s;
  return node < 1.01 * host + longest_wait_s && node < longest_offline_s;
}

/// The exchanges of a piece, without those left out and those in doubt.
PieceBounds collect(const OfflineWalk& walk, std::size_t p,
                    std::span<const DoubtfulStretch> doubtful, ClockPieceModel& model) {
  PieceBounds piece;
  bool begun = false;
  const auto [first, end] = range_of(walk, p);
  model.violators = 0;
  for (std::size_t i = first; i < end; ++i) {
    if (walk.late[i]) continue;
    const Exchange& e = walk.exchanges[i];
    if (!std::exchange(begun, true)) {
      piece.origin = {e.n_tx, e.h_rx};
      model.first = e.h_rx;
      model.boot = e.boot;
    }
    model.last = e.h_rx;
    model.violators += (walk.up_left_out[i] ? 1U : 0U) + (walk.echo_left_out[i] ? 1U : 0U);
    if (is_in(doubtful, e.h_rx)) continue;
    if (!walk.up_left_out[i]) piece.add(Side::above, e.n_tx, e.h_rx);
    // The echo of the first frame reached the node before the counter stepped.
    if (e.echo && i != first && !walk.echo_left_out[i])
      piece.add(Side::below, e.echo->n_rx, e.echo->h_tx);
  }
  model.up = piece.up;
  model.down = piece.down;
  return piece;
}

}  // namespace

// Bounds of doubtful stretches are left out first. If nothing else remains, they still give the
// likeliest offset, without a certificate.
OfflineClock fit_offline_clock(std::span<const Exchange> exchanges,
                               const Assumptions& assumptions) {
  OfflineWalk walk = walk_offline(exchanges, assumptions);
  OfflineClock out;
  for (std::size_t p = 0; p < walk.pieces.size(); ++p) {
    ClockPieceModel& model = out.model.pieces.emplace_back();
    PieceBounds piece = collect(walk, p, walk.doubtful, model);
    const bool in_doubt = piece.bounds.empty();  // even then there is a likeliest offset
    if (in_doubt) piece = collect(walk, p, {}, model);
    if (piece.up > 0 && piece.down > 0 && counted_like_the_host(piece))
      fit(piece, walk.least_width, walk.pieces[p].assumptions, model);
    model.certified = model.certified && !in_doubt;
    model.certified_from = walk.pieces[p].certified_from;
  }
  out.model.doubtful = std::move(walk.doubtful);
  out.events = std::move(walk.events);
  return out;
}

}  // namespace kinalign
