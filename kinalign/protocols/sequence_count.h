// SPDX-License-Identifier: Apache-2.0
// Counts packets by the numbers that their sender gives them. A packet is new, late or a duplicate,
// or its sender has restarted. This class extends the Counter of kinalign/wire, which does not
// detect restarts and outliers.
#pragma once

#include "kinalign/wire/counter.h"

#include <cstdint>

namespace kinalign {

/// How a packet's number compares with the numbers that arrived before.
enum class Order {
  newest,     // the first packet, or the highest number; skipped numbers count as lost
  late,       // arrived after a newer packet; it does not count as lost any more
  duplicate,  // its number arrived before
  outlier,    // a number far ahead without a restart; no numbers count as lost before it
  restart     // the sender seems to have restarted; the next packet may undo this, see `outliers`
};

struct SequenceCounts {
  std::uint64_t received = 0;  // all packets
  std::uint64_t lost = 0;      // missing numbers above the lowest number that arrived
  std::uint64_t late = 0;
  std::uint64_t duplicates = 0;
  std::uint64_t restarts = 0;
  std::uint64_t outliers = 0;  // packets with a number far away that did not change the count

  bool operator==(const SequenceCounts&) const = default;
  /// Adds the counts of another run of the sender.
  SequenceCounts& operator+=(const SequenceCounts& more) {
    received += more.received;
    lost += more.lost;
    late += more.late;
    duplicates += more.duplicates;
    restarts += more.restarts;
    outliers += more.outliers;
    return *this;
  }
};

/// The position of a packet among all packets of its sender.
struct SequencePlace {
  std::uint64_t run = 0;    // a new value after each restart and each outlier
  std::int64_t number = 0;  // the unwrapped number; only numbers of the same run can be compared
};

/// Counts packets by numbers of 1 to 64 bits and follows their wraps. An object takes 0.5 kB.
/// A number 1024 or more away begins a new count. If the next packet continues the old count, the
/// number was an outlier and is undone. If the new count begins less than an hour of packets ahead,
/// the skipped numbers count as lost; otherwise the sender counts as restarted. A restart less than
/// 1024 numbers back looks like duplicates for 16 packets. A restart ahead of the old count can't
/// be distinguished from a loss.
/// If the caller knows that the sender did not restart, a number 1024 or more away changes nothing.
/// It is then a duplicate if it is behind the newest number, or an outlier if it is ahead. No
/// number counts as lost because of it.
class SequenceCount {
 public:
  explicit SequenceCount(unsigned bits = 32) : bits_(bits) {}

  /// `may_restart`: false if the caller knows that the packet is older than the newest packet. A
  /// restart of the sender is then excluded.
  Order push(std::uint64_t sent, bool may_restart = true);
  SequenceCounts counts() const;
  /// The position of the latest packet.
  SequencePlace place() const { return {runs_, now_.previous}; }

 private:
  struct State {
    Counter numbers;            // numbers since the last restart
    SequenceCounts counts;      // `lost` only counts numbers before the last restart
    std::int64_t previous = 0;  // the latest number
    std::uint64_t old_run = 0;  // packets in the current run of old numbers that rise by one
  };

  /// True if the number is less than 1024 numbers before or after the newest number.
  bool is_near(const State& state, std::uint64_t sent) const;
  void begin(std::int64_t number);
  void take(std::int64_t number);
  /// Handles a number 1024 or more away: a loss, a restart or an outlier.
  Order leap(std::int64_t number, bool may_restart);
  Order old_number(std::int64_t number, bool may_restart);

  unsigned bits_;
  State now_, before_;
  std::uint64_t runs_ = 0;  // not in State, so that the run of an outlier is never used again
  bool leapt_ = false;      // the last packet began a new count, and `before_` is the old one
};

}  // namespace kinalign
