// SPDX-License-Identifier: Apache-2.0
// Second step of the offline clock: fits each piece that the walk (offline_walk.h) found to all its
// bounds.
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
constexpr double longest_offline_s = 1e6;  // eleven days; each second needs memory for a knot

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
  std::sort(bounds.begin(), bounds.end(),  // adding at the end is fast, inserting is slow
            [](const Bound& a, const Bound& b) { return a.s < b.s; });
  Certificate certificate(assumptions);
  for (const Bound& b : bounds) certificate.add(b);
  return certificate;
}

// The knots of a piece. Its certainty is determined later.
struct Knots {
  std::vector<ClockKnot> knots;
  bool sound = true;  // no contradiction, and no interval narrower than the least width
};

/// Computes a knot for each second, with the likeliest offset and the interval. The interval is
/// widened to allow for the curvature between knots.
Knots knots_of(const PieceBounds& piece, const Certificate& certificate, OfflineEstimate& estimate,
               double least_width) {
  double begin = piece.bounds.front().s, end = begin;
  for (const Bound& b : piece.bounds) {
    begin = std::min(begin, b.s);
    end = std::max(end, b.s);
  }
  const double widened = certificate.assumptions().curvature * knot_s * knot_s / 8.0;
  // The offset between the origins is added in whole nanoseconds, because a double may not hold it
  // exactly.
  const Duration base = piece.origin.host.time_since_epoch() - piece.origin.node.time_since_epoch();
  const auto count = static_cast<std::size_t>(std::ceil((end - begin) / knot_s)) + 1;
  Knots out;
  for (std::size_t i = 0; i < count; ++i) {
    const Duration since = nanoseconds(std::round((begin + knot_s * static_cast<double>(i)) * 1e9));
    const double t = seconds(since), likeliest = estimate.at(t);
    const auto range = certificate.at(t);
    // The assumptions are wrong for the whole piece if the bounds contradict each other at one knot
    // or the interval is too narrow there.
    out.sound = out.sound && range && range->high - range->low >= least_width;
    const double low = range ? range->low : likeliest, high = range ? range->high : likeliest;
    out.knots.push_back({piece.origin.node + since,
                         base + nanoseconds(std::round(std::clamp(likeliest, low, high) * 1e9)),
                         base + nanoseconds(std::floor((low - widened) * 1e9)),
                         base + nanoseconds(std::ceil((high + widened) * 1e9))});
  }
  return out;
}

/// Fits a piece under the assumptions that the live clock had. If the piece contradicts them, it is
/// not certified.
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

/// Returns whether the counter advanced about as far as the host's clock. In a piece of two frames,
/// no certificate can exclude a faulty counter. The piece would then get a knot for each of a huge
/// number of seconds.
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

/// Collects the exchanges of a piece, except ignored and doubtful ones.
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
    // The echo in the first frame is from before the step of the counter.
    if (e.echo && i != first && !walk.echo_left_out[i])
      piece.add(Side::below, e.echo->n_rx, e.echo->h_tx);
  }
  model.up = piece.up;
  model.down = piece.down;
  return piece;
}

}  // namespace

// Bounds in doubtful stretches are omitted first. If no other bounds remain, they give the
// likeliest offset without a certificate.
OfflineClock fit_offline_clock(std::span<const Exchange> exchanges,
                               const Assumptions& assumptions) {
  OfflineWalk walk = walk_offline(exchanges, assumptions);
  OfflineClock out;
  for (std::size_t p = 0; p < walk.pieces.size(); ++p) {
    ClockPieceModel& model = out.model.pieces.emplace_back();
    PieceBounds piece = collect(walk, p, walk.doubtful, model);
    const bool in_doubt = piece.bounds.empty();  // a doubtful piece also gets a likeliest offset
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
