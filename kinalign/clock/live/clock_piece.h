// SPDX-License-Identifier: Apache-2.0
// One continuous stretch of a node's counter: its certificate, its estimate, and the crossings that
// contradict the certificate.
#pragma once

#include "kinalign/clock/clock_stamp.h"
#include "kinalign/clock/live/bound_journal.h"
#include "kinalign/clock/live/certificate.h"
#include "kinalign/clock/live/floor_log.h"
#include "kinalign/clock/live/offset_estimate.h"
#include "kinalign/clock/live/violators.h"

#include <cstdint>
#include <optional>

namespace kinalign {

class ClockPiece {
 public:
  /// All seconds of the piece count from `origin`, so doubles keep their precision however long the
  /// node has run. `prior` and `shortest` come from the node's earlier pieces.
  ClockPiece(const ClockOrigin& origin, const Assumptions& assumptions, SlopeBelief prior = {},
             const ShortestRoundTrips& shortest = {})
      : origin_(origin),
        begin_(origin.host),
        newest_arrival_(origin.host),
        certificate_(assumptions, corners),
        estimate_(prior),
        floors_(shortest) {}

  enum class Verdict : std::uint8_t {
    taken,
    violator,  // contradicts the certificate; left out
    broken,    // several violators that must be believed, or bounds that leave no value in between
    slipped,   // taken; the floors show a step of the counter that is too small for the certificate
    uneasy     // taken; the same, but so small that the certificate still holds
  };
  /// Judges a crossing, and takes it unless it contradicts the certificate. Call it in the order of
  /// arrival.
  Verdict push(const Crossing& crossing);

  /// The host's time for reading n. Absent before there is a crossing of each kind, and more than
  /// three years away.
  std::optional<ClockStamp> at(NodeTime n);

  /// After `broken` or `slipped`: the piece that begins here.
  ClockPiece next_piece() const;
  HostTime next_begins() const;
  /// After `broken` or `slipped`: arrivals from this time on have stamps in doubt in this piece.
  HostTime doubtful_since() const;

  /// The time since when a step is likely, although three violators have not confirmed it yet.
  /// Meanwhile nothing is certified.
  std::optional<HostTime> step_pending_since() const;

  const ClockOrigin& origin() const { return origin_; }
  HostTime begins() const { return begin_; }  // arrival of its first frame
  /// Readings before this time may come from before a step and are not certified. Nobody asks for
  /// readings more than ten seconds older than a frame by which a step back is noticed.
  HostTime certified_from() const { return certified_from_; }
  const Assumptions& assumptions() const { return certificate_.assumptions(); }
  const OffsetEstimate& estimate() const { return estimate_; }
  const FloorLog& floors() const { return floors_; }
  /// After a verdict: the distance to the certificate, or the size of the counter's step, s. Absent
  /// if bounds contradict each other.
  std::optional<double> amount() const {
    return end_ == End::contradiction ? std::nullopt : std::optional(amount_);
  }

 private:
  static constexpr std::size_t corners = 255;

  enum class End : std::uint8_t {  // reason for the end of a piece
    none,
    violators,
    overdue_violator,
    contradiction,  // bounds leave no value between them
    narrowed,       // bounds leave less than packets take; the time of the slip is unknown
    slip_with_route,
    slip_between_windows
  };
  /// Between readings and seconds from the origin.
  Bound bound(const Crossing& crossing) const;
  HostTime host_time(const Bound& e) const;
  /// Computes the certificate's range at s and keeps it in `range_`.
  void ask(double s);
  double violation(const Bound& e);
  void add(const Bound& e);
  Verdict broken(End why);
  /// The three signs of a step that is too small for the certificate; each returns its size, s.
  std::optional<double> stepped_between_windows();
  std::optional<double> stepped_with_route();
  std::optional<double> narrowed();
  std::optional<Verdict> slipped();
  HostTime doubt_of_violators() const;
  HostTime about(double s) const;
  bool may_bend() const;
  Duration greatest_step_back() const;
  ClockPiece next_behind(const Assumptions& assumed, const SlopeBelief& prior) const;
  ClockPiece next_after_slip(const Assumptions& assumed, const SlopeBelief& prior) const;

  ClockOrigin origin_;
  HostTime begin_, newest_arrival_;  // arrivals of the first and the newest frame
  HostTime certified_from_ = HostTime::min();
  /// The next four hold the same bounds: what is possible, what is likely, their order, and their
  /// least delays. Violators are in none of them.
  Certificate certificate_;
  OffsetEstimate estimate_;
  BoundJournal journal_;
  FloorLog floors_;
  std::uint64_t windows_judged_ = 0;
  Violators violators_;
  std::uint64_t crossings_ = 0;
  End end_ = End::none;
  std::uint32_t routes_judged_ = 0;
  double amount_ = 0.0;
  /// The range of x at range_at_ when it was last computed; unseen_ counts the bounds since then
  /// that would narrow it.
  std::optional<ValueRange> range_;
  double range_at_ = 0.0;
  bool contradicted_ = false;  // bounds leave no value between them
  std::uint32_t unseen_ = 0;
};

}  // namespace kinalign
