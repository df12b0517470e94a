// SPDX-License-Identifier: Apache-2.0
// First the live clock walks through all exchanges and says where pieces begin, which stretches are
// in doubt and what can't be; then each piece is fitted to all that is left of it.
#include "kinalign/clock/offline_clock.h"

#include "kinalign/clock/bound.h"
#include "kinalign/clock/certificate.h"
#include "kinalign/clock/live_clock.h"
#include "kinalign/clock/offline_estimate.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kinalign {

namespace {

constexpr double knot_s = 1.0;
constexpr double longest_wait_s = 60.0;    // of a packet
constexpr double longest_offline_s = 1e6;  // eleven days, of a knot a second

struct Walk {
  std::span<const Exchange> exchanges;
  std::vector<ClockEvent> events;
  std::vector<DoubtfulStretch> doubtful;
  std::vector<std::size_t> piece;  // of each exchange
  std::vector<bool> up_left_out, echo_left_out;
  std::vector<bool> late;  // exchanges of a life that was over when they came
  std::size_t pieces = 0;
  std::vector<Assumptions> assumed;      // of each piece
  std::vector<HostTime> certified_from;  // likewise
  double least_width = 0.0;  // s, that an interval can have: packets took no less, there and back
};

bool begins_piece(ClockEvent::Kind kind) {
  using Kind = ClockEvent::Kind;
  return kind == Kind::new_boot || kind == Kind::step || kind == Kind::slip ||
         kind == Kind::settled || kind == Kind::host_backwards;
}

/// What happened with exchange i: pieces that begin reach back to where they do.
void note(Walk& walk, std::size_t i, const ClockEvent& event, Side of) {
  if (event.kind == ClockEvent::Kind::withdrawn) {
    const ClockEvent& why = walk.events.back();  // told before, but for what a reboot cuts short
    const HostTime end = begins_piece(why.kind) ? why.begin - Duration{1} : event.end;
    if (event.begin <= end) walk.doubtful.push_back({event.begin, end});
    return;
  }
  walk.events.push_back(event);
  if (event.kind == ClockEvent::Kind::violator)
    (of == Side::below ? walk.echo_left_out : walk.up_left_out)[i] = true;
  if (!begins_piece(event.kind)) return;
  const std::size_t next = walk.pieces++;
  const auto is_of_it = [&](std::size_t k) {
    const Exchange& e = walk.exchanges[k];
    if (event.kind == ClockEvent::Kind::host_backwards) return k == i;  // what was is of that time
    return e.h_rx >= event.begin && (walk.late[k] || e.boot == event.boot);
  };
  for (std::size_t k = i + 1; k-- > 0 && is_of_it(k);) walk.piece[k] = next;
}

/// The exchanges of piece p, which follow each other.
struct ExchangeRange {
  std::size_t begin = 0, end = 0;
};
ExchangeRange exchanges_of(const Walk& walk, std::size_t p) {
  const auto [first, last] = std::equal_range(walk.piece.begin(), walk.piece.end(), p);  // rising
  return {static_cast<std::size_t>(first - walk.piece.begin()),
          static_cast<std::size_t>(last - walk.piece.begin())};
}

/// A crossing that can't be may be the first of a step that a reboot or the end cut short, or that
/// was undone: live the five seconds before it are withdrawn, those behind it are in doubt as well.
void doubt_behind_violators(Walk& walk) {
  for (std::size_t i = 0; i < walk.exchanges.size(); ++i) {
    if (!walk.up_left_out[i] && !walk.echo_left_out[i]) continue;
    const HostTime h = walk.exchanges[i].h_rx;
    const Exchange& last = walk.exchanges[exchanges_of(walk, walk.piece[i]).end - 1];
    walk.doubtful.push_back({h, std::min(last.h_rx, h + Violators::wait)});
  }
}

/// Rising, without those that others reach over.
std::vector<DoubtfulStretch> merged(std::vector<DoubtfulStretch> all) {
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.begin < b.begin; });
  std::vector<DoubtfulStretch> out;
  for (const DoubtfulStretch& d : all) {
    if (out.empty() || d.begin > out.back().end) {
      out.push_back(d);
    } else {
      out.back().end = std::max(out.back().end, d.end);
    }
  }
  return out;
}

/// What the clock says of exchange i, or of its echo.
void hear(Walk& walk, std::size_t i, LiveClock& clock, Side of) {
  for (const ClockEvent& event : clock.take_events()) note(walk, i, event, of);
  walk.assumed.resize(walk.pieces, clock.piece()->assumptions());
  walk.certified_from.resize(walk.pieces, clock.piece()->certified_from());
}

bool cuts_short(ClockEvent::Kind kind) {
  return kind == ClockEvent::Kind::new_boot || kind == ClockEvent::Kind::host_backwards;
}

Walk walk_through(std::span<const Exchange> exchanges, const Assumptions& assumptions) {
  Walk walk;
  walk.exchanges = exchanges;
  walk.piece.resize(exchanges.size());
  walk.up_left_out.resize(exchanges.size());
  walk.echo_left_out.resize(exchanges.size());
  walk.late.resize(exchanges.size());
  LiveClock clock(assumptions);
  for (std::size_t i = 0; i < exchanges.size(); ++i) {
    const Exchange& e = exchanges[i];
    walk.piece[i] = walk.pieces == 0 ? 0 : walk.pieces - 1;
    const auto late = clock.late_crossings();
    const auto unsettled = clock.unsettled_since();
    clock.push_up(e.boot, e.n_tx, e.h_rx);
    if (clock.late_crossings() > late) {
      walk.late[i] = true;
      continue;
    }
    hear(walk, i, clock, Side::above);
    if (unsettled && cuts_short(walk.events.back().kind))  // it never will settle
      walk.doubtful.push_back({*unsettled, exchanges[i - 1].h_rx});
    if (e.echo) {
      clock.push_down(e.boot, e.echo->n_rx, e.echo->h_tx);
      hear(walk, i, clock, Side::below);
    }
    // Its estimate is refreshed when it is asked: this one sees what one in use does.
    static_cast<void>(clock.host_from_node(e.boot, e.n_tx));
  }
  if (const ClockPiece* last = clock.piece()) {
    walk.least_width = last->floors().least_width();
    for (const auto& since : {last->uneasy_since(), clock.unsettled_since()}) {
      if (since) walk.doubtful.push_back({*since, exchanges.back().h_rx});
    }
  }
  doubt_behind_violators(walk);
  walk.doubtful = merged(std::move(walk.doubtful));
  return walk;
}

/// The bounds of a piece in seconds from its first exchange.
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
  std::sort(bounds.begin(), bounds.end(),  // appending is cheap, inserting is not
            [](const Bound& a, const Bound& b) { return a.s < b.s; });
  Certificate certificate(assumptions);
  for (const Bound& b : bounds) certificate.add(b);
  return certificate;
}

Duration nanoseconds(double ns) { return Duration{static_cast<std::int64_t>(ns)}; }

struct Knots {
  std::vector<ClockKnot> knots;
  bool sound = true;  // bounds go together everywhere, and leave what there is at least
};

Knots knots_of(const PieceBounds& piece, const Certificate& certificate, OfflineEstimate& estimate,
               double least_width) {
  double begin = piece.bounds.front().s, end = begin;
  for (const Bound& b : piece.bounds) {
    begin = std::min(begin, b.s);
    end = std::max(end, b.s);
  }
  const double widened = certificate.assumptions().curvature * knot_s * knot_s / 8.0;
  const Duration base = piece.origin.host.time_since_epoch() - piece.origin.node.time_since_epoch();
  const auto count = static_cast<std::size_t>(std::ceil((end - begin) / knot_s)) + 1;
  Knots out;
  for (std::size_t i = 0; i < count; ++i) {
    const Duration since = nanoseconds(std::round((begin + knot_s * static_cast<double>(i)) * 1e9));
    const double t = seconds(since), likeliest = estimate.at(t);
    const auto range = certificate.at(t);
    out.sound = out.sound && range && range->high - range->low >= least_width;
    const double low = range ? range->low : likeliest, high = range ? range->high : likeliest;
    out.knots.push_back({piece.origin.node + since,
                         base + nanoseconds(std::round(std::clamp(likeliest, low, high) * 1e9)),
                         base + nanoseconds(std::floor((low - widened) * 1e9)),
                         base + nanoseconds(std::ceil((high + widened) * 1e9))});
  }
  return out;
}

/// Under the assumptions of the live clock then: a piece that contradicts them has no certificate.
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

/// Whether a counter counted about as long as the host did: a piece of two frames has no
/// certificate yet that would have left out a wild one, and knots are one a second.
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

/// All exchanges of a piece but those that can't be and those that are in doubt.
PieceBounds collect(const Walk& walk, std::size_t p, std::span<const DoubtfulStretch> doubtful,
                    ClockPieceModel& model) {
  PieceBounds piece;
  bool begun = false;
  const auto [first, end] = exchanges_of(walk, p);
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
    // What the first one echoes reached the node before the counter stepped.
    if (e.echo && i != first && !walk.echo_left_out[i])
      piece.add(Side::below, e.echo->n_rx, e.echo->h_tx);
  }
  model.up = piece.up;
  model.down = piece.down;
  return piece;
}

}  // namespace

OfflineClock fit_offline_clock(std::span<const Exchange> exchanges,
                               const Assumptions& assumptions) {
  Walk walk = walk_through(exchanges, assumptions);
  OfflineClock out;
  for (std::size_t p = 0; p < walk.pieces; ++p) {
    ClockPieceModel& model = out.model.pieces.emplace_back();
    PieceBounds piece = collect(walk, p, walk.doubtful, model);
    const bool in_doubt = piece.bounds.empty();  // something is likeliest all the same
    if (in_doubt) piece = collect(walk, p, {}, model);
    if (piece.up > 0 && piece.down > 0 && counted_like_the_host(piece))
      fit(piece, walk.least_width, walk.assumed[p], model);
    model.certified = model.certified && !in_doubt;
    model.certified_from = walk.certified_from[p];
  }
  out.model.doubtful = std::move(walk.doubtful);
  out.events = std::move(walk.events);
  return out;
}

}  // namespace kinalign
