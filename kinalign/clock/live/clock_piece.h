// SPDX-License-Identifier: Apache-2.0
// One stretch of a node's counter without a break: its certificate, its estimate, and the watch
// over exchanges that can't be.
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
  ClockPiece(const ClockOrigin& origin, const Assumptions& assumptions, SlopeBelief prior = {},
             const ShortestRoundTrips& shortest = {})
      : origin_(origin),
        begin_(origin.host),
        heard_(origin.host),
        certificate_(assumptions, corners),
        estimate_(prior),
        floors_(shortest) {}

  enum class Verdict : std::uint8_t {
    taken,
    violator,  // against the certificate: left out
    broken,    // violators that are to be believed, or bounds without any way between them
    slipped,   // taken; the floors say that the counter stepped, by less than the certificate sees
    uneasy     // taken; likewise, by so little that the certificate holds all the same
  };
  Verdict push(const Crossing& crossing);

  /// Absent until there is a crossing of each kind, and more than three years away.
  std::optional<ClockStamp> at(NodeTime n);

  /// After `broken` or `slipped`: the piece that begins here, …
  ClockPiece next_piece() const;
  HostTime next_begins() const;
  /// … and since when the stamps of this one are in doubt, by the frames' arrival.
  HostTime doubtful_since() const;

  /// Since when a step is likely that three violators have not shown yet. While it is, nothing is
  /// certified.
  std::optional<HostTime> step_pending_since() const;

  const ClockOrigin& origin() const { return origin_; }
  HostTime begins() const { return begin_; }  // its first arrival
  /// Readings of before this may be of before the counter stepped, and are not certified. Nobody
  /// asks for readings of more than ten seconds before a frame in which one that stepped back is
  /// heard.
  HostTime certified_from() const { return certified_from_; }
  const Assumptions& assumptions() const { return certificate_.assumptions(); }
  const OffsetEstimate& estimate() const { return estimate_; }
  const FloorLog& floors() const { return floors_; }
  /// Behind the verdict: how far beyond the certificate, or how far the counter stepped, s. Absent
  /// where bounds contradict each other.
  std::optional<double> amount() const {
    return end_ == End::contradiction ? std::nullopt : std::optional(amount_);
  }

 private:
  static constexpr std::size_t corners = 255;

  enum class End : std::uint8_t {  // why a piece is over
    none,
    violators,
    overdue_violator,
    contradiction,  // bounds without a way between them, or …
    narrowed,       // … less than packets take: since when is not known
    slip_with_route,
    slip_between_windows
  };
  Bound bound(const Crossing& crossing) const;
  HostTime host_time(const Bound& e) const;
  void ask(double s);
  double violation(const Bound& e);
  void add(const Bound& e);
  Verdict broken(End why);
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
  HostTime begin_, heard_;  // first and newest arrival
  HostTime certified_from_ = HostTime::min();
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
  /// What x could be at range_at_ when it was asked last, and how many bounds came since.
  std::optional<ValueRange> range_;
  double range_at_ = 0.0;
  bool contradicted_ = false;  // bounds leave no way between them
  std::uint32_t unseen_ = 0;
};

}  // namespace kinalign
