// SPDX-License-Identifier: Apache-2.0
#include "kinalign/clock/offline/device_clock.h"

#include "kinalign/clock/bound.h"
#include "kinalign/clock/offline/offline_clock.h"
#include "kinalign/clock/offline/one_way_clock.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace kinalign {

namespace {

/// Greatest age of a sample in a frame. An older sample belongs to the previous piece.
constexpr Duration oldest_sample = std::chrono::seconds(2);

/// Chosen, not measured: twice the error allowed for a stated rate
/// (recording/streams/counted_clock.h). A faulty counter may have any rate.
constexpr double most_drift_ppm = 20'000.0;

/// Fits the exchanges of one boot; `indices` are their indices in `exchanges`. Consecutive
/// exchanges are not copied, because an hour of a device takes 20 MB.
HostFromNode fit_one_way(std::span<const Exchange> exchanges,
                         std::span<const std::size_t> indices) {
  if (indices.empty()) return {};
  if (indices.back() - indices.front() + 1 == indices.size()) {
    return fit_one_way_clock(exchanges.subspan(indices.front(), indices.size()));
  }
  std::vector<Exchange> received;
  received.reserve(indices.size());
  for (const std::size_t i : indices) received.push_back(exchanges[i]);
  return fit_one_way_clock(received);
}

/// Gives pieces without replies a clock that uses only arrivals.
HostFromNode with_one_way(HostFromNode model, std::span<const Exchange> exchanges) {
  HostFromNode out;
  out.doubtful = std::move(model.doubtful);
  std::unordered_map<BootKey, std::vector<std::size_t>> exchanges_of;  // boots without replies
  for (const ClockPieceModel& piece : model.pieces) {
    // The access creates an empty entry, so that the loop below collects the exchanges of these
    // boots.
    if (piece.knots.empty()) exchanges_of[piece.boot];
  }
  for (std::size_t i = 0; i < exchanges.size(); ++i) {
    const auto found = exchanges_of.find(exchanges[i].boot);
    if (found != exchanges_of.end()) found->second.push_back(i);
  }
  for (ClockPieceModel& piece : model.pieces) {
    if (!piece.knots.empty()) {
      out.pieces.push_back(std::move(piece));
      continue;
    }
    std::vector<std::size_t> received;
    const std::vector<std::size_t>& of_boot = exchanges_of[piece.boot];
    std::copy_if(of_boot.begin(), of_boot.end(), std::back_inserter(received), [&](std::size_t i) {
      return piece.first <= exchanges[i].h_rx && exchanges[i].h_rx <= piece.last;
    });
    HostFromNode fitted = fit_one_way(exchanges, received);
    std::move(fitted.pieces.begin(), fitted.pieces.end(), std::back_inserter(out.pieces));
  }
  return out;
}

Time stamp_at(NodeTime n, Duration moved) { return Time{n.time_since_epoch() + moved}; }

HostTime host_at(const ClockKnot& knot) {
  return HostTime{knot.node.time_since_epoch() + knot.offset};
}

/// Returns whether a step or a doubtful stretch is at or near the line between two knots.
bool is_doubtful(const HostFromNode& model, const ClockPieceModel& piece, const ClockKnot& a,
                 const ClockKnot& b) {
  constexpr Duration around = std::chrono::seconds(1);
  // The margin of a second is needed because a stretch refers to arrivals and knots refer to
  // readings.
  const HostTime begin = host_at(a) - around, end = host_at(b) + around;
  if (!is_behind_step(host_at(a) - (a.offset - a.least), piece.certified_from, piece.last))
    return true;
  return std::any_of(model.doubtful.begin(), model.doubtful.end(), [&](const auto& stretch) {
    return stretch.begin <= end && begin <= stretch.end;
  });
}

/// Returns the greatest distance between the likeliest offset and an end of the interval between
/// two knots.
Duration half_width_of(const ClockKnot& a, const ClockKnot& b) {
  return std::max({a.offset - a.least, a.greatest - a.offset, b.offset - b.least,
                   b.greatest - b.offset}) +
         counter_resolution;
}

/// Appends a line for each pair of neighbouring knots.
void append_lines(const HostFromNode& model, const ClockPieceModel& piece, Duration moved,
                  Duration utc_minus_host, TimeModel& time) {
  for (std::size_t k = 0; k < piece.knots.size(); ++k) {
    const ClockKnot& a = piece.knots[k];
    const ClockKnot& b = k + 1 < piece.knots.size() ? piece.knots[k + 1] : a;
    TimeModelPiece line;
    line.begin = stamp_at(a.node, moved);
    line.offset = a.offset - moved + utc_minus_host + counter_resolution / 2;
    if (b.node > a.node) {
      line.drift_ppm = 1e6 * seconds(b.offset - a.offset) / seconds(b.node - a.node);
    } else if (k > 0) {
      line.drift_ppm = time.pieces.back().drift_ppm;  // the last knot continues the previous line
    }
    if (std::abs(line.drift_ppm) > most_drift_ppm) line.drift_ppm = 0.0;
    if (piece.certified && !is_doubtful(model, piece, a, b)) line.half_width = half_width_of(a, b);
    time.pieces.push_back(line);
  }
}

/// Begins the first line early enough for samples that are older than the first frame, but not
/// before the end of the previous piece.
void reach_back(TimeModel& time, std::size_t first, std::optional<Time> last_stamp) {
  TimeModelPiece& line = time.pieces[first];
  Time begin = line.begin - oldest_sample;
  if (last_stamp) begin = std::max(begin, *last_stamp + Duration{1});
  if (begin >= line.begin) return;
  line.offset -= nanoseconds(
      std::round(line.drift_ppm * 1e-6 * static_cast<double>((line.begin - begin).count())));
  line.begin = begin;
}

/// Prevents UTC from going back, from line `first` on, where stamps continue from the previous
/// line. A line that would begin before the end of the previous line begins at that end, because
/// later stamps belong to later moments.
void keep_rising(TimeModel& time, std::size_t first) {
  for (std::size_t i = std::max<std::size_t>(first, 1); i < time.pieces.size(); ++i) {
    TimeModelPiece& line = time.pieces[i];
    if (line.half_width) continue;
    const TimeModelPiece& before = time.pieces[i - 1];
    const double run = static_cast<double>((line.begin - before.begin).count());
    const Duration end = before.offset + nanoseconds(std::round(before.drift_ppm * 1e-6 * run));
    line.offset = std::max(line.offset, end);
  }
}

/// Returns the smallest shift that keeps stamps rising: the shift of the last piece, or the shift
/// with which stamps continue as long as the host's clock counted.
Duration move_of(const ClockPieceModel& piece, const ClockPieceModel& before, Duration moved) {
  const ClockKnot &end = before.knots.back(), &begin = piece.knots.front();
  if (piece.boot == before.boot && begin.node > end.node) return moved;
  // The gap is at least twice the greatest age of a sample, so that old samples of the new piece
  // have later stamps than the previous piece.
  const Duration between = std::max(host_at(begin) - host_at(end), 2 * oldest_sample);
  return end.node.time_since_epoch() + moved + between - begin.node.time_since_epoch();
}

}  // namespace

// A piece without knots also has an entry in `moved`, so that both lists have the same indices.
DeviceClock device_clock(std::span<const Exchange> exchanges, Duration utc_minus_host) {
  DeviceClock out;
  out.model = with_one_way(fit_offline_clock(exchanges).model, exchanges);
  out.time.pieces.clear();
  const ClockPieceModel* before = nullptr;
  std::optional<Time> last_stamp;  // the last stamp of the previous piece
  for (const ClockPieceModel& piece : out.model.pieces) {
    const Duration last_moved = out.moved.empty() ? Duration{0} : out.moved.back();
    Duration moved = last_moved;
    if (!piece.knots.empty()) {
      if (before != nullptr) moved = move_of(piece, *before, moved);
      const std::size_t first = out.time.pieces.size();
      append_lines(out.model, piece, moved, utc_minus_host, out.time);
      reach_back(out.time, first, last_stamp);
      // The stamps continue without a shift, so UTC must continue to rise.
      if (before != nullptr && moved == last_moved) keep_rising(out.time, first);
      last_stamp = stamp_at(piece.knots.back().node, moved);
      before = &piece;
    }
    out.moved.push_back(moved);
  }
  if (out.time.pieces.empty()) out.time = TimeModel{};
  for (std::size_t p = 0; p < out.model.pieces.size(); ++p) {
    const ClockPieceModel& piece = out.model.pieces[p];
    if (!piece.knots.empty()) out.pieces_of[piece.boot].push_back(p);
  }
  return out;
}

std::optional<Time> stamp_of(const DeviceClock& clock, BootKey boot, NodeTime n, HostTime h_rx) {
  const auto of_boot = clock.pieces_of.find(boot);
  if (of_boot == clock.pieces_of.end()) return std::nullopt;
  const auto& pieces = clock.model.pieces;
  std::optional<std::size_t> found;
  for (const std::size_t p : of_boot->second) {
    // A frame before the first piece of its boot uses the first piece. A frame between two pieces
    // or after the last piece uses the piece before the frame.
    if (found && h_rx < pieces[p].first) continue;
    found = p;
    if (h_rx <= pieces[p].last) break;
  }
  if (!found) return std::nullopt;
  return stamp_at(n, clock.moved[*found]);
}

}  // namespace kinalign
