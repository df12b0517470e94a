// SPDX-License-Identifier: Apache-2.0
// Counts packets by the number that the sender gives each of them: lost, duplicate, late, or a
// restart of the sender. It adds to the Counter of wire the detection of restarts and outliers.
#pragma once

#include "kinalign/wire/counter.h"

#include <cstdint>

namespace kinalign {

/// A packet compared with those that arrived before it.
enum class Order {
  newest,     // the first packet, or the highest number so far; numbers that were skipped are lost
  late,       // it arrived after a newer packet; if it was counted as lost, it no longer is
  duplicate,  // its number arrived before
  outlier,    // its number is far ahead, but the sender did not restart; nothing is lost before it
  restart     // the sender restarted, or so it seems until the next packet; see `outliers`
};

struct SequenceCounts {
  std::uint64_t received = 0;  // all packets
  std::uint64_t lost = 0;      // numbers that are missing above the lowest number that arrived
  std::uint64_t late = 0;
  std::uint64_t duplicates = 0;
  std::uint64_t restarts = 0;
  std::uint64_t outliers = 0;  // packets with a number far away, which changed nothing

  bool operator==(const SequenceCounts&) const = default;
  /// Adds the counts of an earlier run of the sender.
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

/// A packet's place among all packets of its sender.
struct SequencePlace {
  std::uint64_t run = 0;    // changes at each restart and at the end of each outlier; never returns
  std::int64_t number = 0;  // unwrapped; numbers of one run are comparable
};

/// Counts packets by numbers of 1 to 64 bits and follows their wraps; takes 0.5 kB.
/// A number 1024 or more away begins a new count. If the next packet continues the old count, the
/// number was an outlier and is undone. A new count that begins less than an hour of packets ahead
/// counts as a loss, not as a restart. A restart less than 1024 numbers back looks like duplicates
/// for 16 packets. A restart ahead of the old count can't be told from a loss.
/// If the caller knows that the sender did not restart, a number 1024 or more away changes nothing.
/// A number behind the newest is then a duplicate, one ahead of it an outlier, and no packet counts
/// as lost before it.
class SequenceCount {
 public:
  explicit SequenceCount(unsigned bits = 32) : bits_(bits) {}

  /// `may_restart`: false if the caller knows that the packet is older than the newest one, so the
  /// sender did not restart with it.
  Order push(std::uint64_t sent, bool may_restart = true);
  SequenceCounts counts() const;
  /// The place of the packet that was pushed last.
  SequencePlace place() const { return {runs_, now_.previous}; }

 private:
  struct State {
    Counter numbers;            // since the last restart
    SequenceCounts counts;      // `lost`: before the last restart
    std::int64_t previous = 0;  // the number pushed last
    std::uint64_t old_run = 0;  // length of the present run of old numbers that rise by one
  };

  /// True if the number lies less than a window before or after the newest one.
  bool is_near(const State& state, std::uint64_t sent) const;
  void begin(std::int64_t number);
  void take(std::int64_t number);
  /// A number far away: a loss, a restart or an outlier.
  Order leap(std::int64_t number, bool may_restart);
  Order old_number(std::int64_t number, bool may_restart);

  unsigned bits_;
  State now_, before_;
  std::uint64_t runs_ = 0;  // not in State: a run that an outlier began is not used again
  bool leapt_ = false;      // the last packet began a new count; `before_` is the old one
};

}  // namespace kinalign
