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

/// Greatest age of a sample in a frame; an older one falls under the piece before.
constexpr Duration oldest_sample = std::chrono::seconds(2);

/// Chosen: twice the error allowed for a stated rate (recording/streams/counted_clock.h). A faulty
/// counter may have any rate.
constexpr double most_drift_ppm = 20'000.0;

/// Fits the exchanges of one boot; `indices` has their indices in `exchanges`. An hour of a device
/// takes 20 MB, so exchanges that follow one another are not copied.
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

/// Gives pieces without replies a clock from their arrivals alone.
HostFromNode with_one_way(HostFromNode model, std::span<const Exchange> exchanges) {
  HostFromNode out;
  out.doubtful = std::move(model.doubtful);
  std::unordered_map<BootKey, std::vector<std::size_t>> exchanges_of;  // boots without replies
  for (const ClockPieceModel& piece : model.pieces) {
    // Creates an empty entry, so that only exchanges of these boots are collected below.
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

/// True if a step or a doubtful stretch lies at or near the line between two knots.
bool is_doubtful(const HostFromNode& model, const ClockPieceModel& piece, const ClockKnot& a,
                 const ClockKnot& b) {
  constexpr Duration around = std::chrono::seconds(1);
  // A second is added on each side, because a stretch concerns arrivals and knots concern readings.
  const HostTime begin = host_at(a) - around, end = host_at(b) + around;
  if (!is_behind_step(host_at(a) - (a.offset - a.least), piece.certified_from, piece.last))
    return true;
  return std::any_of(model.doubtful.begin(), model.doubtful.end(), [&](const auto& stretch) {
    return stretch.begin <= end && begin <= stretch.end;
  });
}

/// Greatest distance from the likeliest offset to an end of the interval between two knots.
Duration half_width_of(const ClockKnot& a, const ClockKnot& b) {
  return std::max({a.offset - a.least, a.greatest - a.offset, b.offset - b.least,
                   b.greatest - b.offset}) +
         counter_resolution;
}

/// Appends a straight line for each pair of neighbouring knots.
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
      line.drift_ppm = time.pieces.back().drift_ppm;  // the last knot continues the line before it
    }
    if (std::abs(line.drift_ppm) > most_drift_ppm) line.drift_ppm = 0.0;
    if (piece.certified && !is_doubtful(model, piece, a, b)) line.half_width = half_width_of(a, b);
    time.pieces.push_back(line);
  }
}

/// Samples may be older than the first frame, so the first line starts that much earlier, but not
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

/// Keeps UTC from falling, from line `first` on, where the stamps continue those of the line
/// before. A guessed line that would begin before the end of the previous line begins at that end.
/// Later stamps belong to later moments, whatever the arrivals suggest.
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

/// The smallest shift that keeps stamps rising: that of the last piece, or one by which the stamps
/// continue for as long as the host counted.
Duration move_of(const ClockPieceModel& piece, const ClockPieceModel& before, Duration moved) {
  const ClockKnot &end = before.knots.back(), &begin = piece.knots.front();
  if (piece.boot == before.boot && begin.node > end.node) return moved;
  // At least twice the greatest age of a sample, so that old samples of the new piece stay after
  // those of the piece before.
  const Duration between = std::max(host_at(begin) - host_at(end), 2 * oldest_sample);
  return end.node.time_since_epoch() + moved + between - begin.node.time_since_epoch();
}

}  // namespace

// Pieces without knots keep their place in `moved`, so that an index means the same in both lists.
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
      // The stamps continue, so UTC must continue to rise with them.
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
    // A frame that arrives before the first piece of its boot uses the first piece. One that
    // arrives between two pieces or after the last uses the piece before it.
    if (found && h_rx < pieces[p].first) continue;
    found = p;
    if (h_rx <= pieces[p].last) break;
  }
  if (!found) return std::nullopt;
  return stamp_at(n, clock.moved[*found]);
}

}  // namespace kinalign
