// SPDX-License-Identifier: Apache-2.0
// One continuous stretch of a node's counter. It contains the certificate, the estimate of the
// offset, and the crossings that contradict the certificate (violators). A crossing is one packet
// in one direction; a floor is the least delay in one direction (docs/clock.md).
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
  /// Seconds of the piece are counted from `origin`, so doubles are precise even if the node has
  /// run for long. `prior` and `shortest` come from the node's earlier pieces.
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
    violator,  // contradicts the certificate; ignored for now
    broken,    // the piece ends: several violators are confirmed, or bounds contradict each other
    slipped,   // added; the piece ends: the floors show a step too small for the certificate
    uneasy     // added; the floors show a step so small that the certificate is still right
  };
  /// Judges a crossing and adds it if it agrees with the certificate. Call in the order of arrival.
  Verdict push(const Crossing& crossing);

  /// Returns the host time for the reading n. Absent before there is a crossing in each direction,
  /// and if n is more than three years from the origin.
  std::optional<ClockStamp> at(NodeTime n);

  /// After `broken` or `slipped`: the piece that follows this one.
  ClockPiece next_piece() const;
  HostTime next_begins() const;
  /// After `broken` or `slipped`: the arrival from which on stamps of this piece are doubtful.
  HostTime doubtful_since() const;

  /// The time since which a step is likely but not yet confirmed by three violators. From this time
  /// on nothing is certified.
  std::optional<HostTime> step_pending_since() const;

  const ClockOrigin& origin() const { return origin_; }
  HostTime begins() const { return begin_; }  // arrival of the first frame
  /// Readings before this time may be from before a step and are not certified. When a step back is
  /// noticed, readings of up to ten seconds ago may still be asked for.
  HostTime certified_from() const { return certified_from_; }
  const Assumptions& assumptions() const { return certificate_.assumptions(); }
  const OffsetEstimate& estimate() const { return estimate_; }
  const FloorLog& floors() const { return floors_; }
  /// After a verdict: the distance to the certificate or the size of the counter's step, s. Absent
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
    contradiction,  // bounds contradict each other
    narrowed,       // the interval became narrower than the least round trip at an unknown time
    slip_with_route,
    slip_between_windows
  };
  /// These two convert between clock readings and seconds from the origin.
  Bound bound(const Crossing& crossing) const;
  HostTime host_time(const Bound& e) const;
  /// Computes the certificate's range at s and stores it in `range_`.
  void ask(double s);
  double violation(const Bound& e);
  void add(const Bound& e);
  Verdict broken(End why);
  /// Three signs of a step that is too small to contradict the certificate. Each function returns
  /// the size of the step, s.
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
  /// The next four members contain the same bounds: for the possible range, for the likeliest
  /// value, in their order, and for the least delays. None contains violators.
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
  /// The range of x when it was last computed, at range_at_. unseen_ counts the later bounds that
  /// would narrow it.
  std::optional<ValueRange> range_;
  double range_at_ = 0.0;
  bool contradicted_ = false;  // bounds contradict each other
  std::uint32_t unseen_ = 0;
};

}  // namespace kinalign
