// SPDX-License-Identifier: Apache-2.0
// Classifies packets by the number that the sender gives each of them: lost, duplicate, late, or a
// restart of the sender. It is for packets that arrive one by one and are judged at once.
// PacketCount (packet_count.h) numbers the rows of a file instead.
#pragma once

#include <array>
#include <cstdint>

namespace kinalign {

/// A packet compared with those that arrived before it.
enum class Order {
  newest,     // the first packet, or the highest number so far; numbers that were skipped are lost
  late,       // it arrived after a newer packet; if it was counted as lost, it no longer is
  duplicate,  // its number arrived before
  stray,      // its number is far ahead, but the sender did not restart; nothing is lost before it
  restart     // the sender restarted, or so it seems until the next packet; see `strays`
};

struct SequenceCounts {
  std::uint64_t received = 0;  // all packets
  std::uint64_t lost = 0;      // numbers that are missing above the lowest number that arrived
  std::uint64_t late = 0;
  std::uint64_t duplicates = 0;
  std::uint64_t restarts = 0;
  std::uint64_t strays = 0;  // packets with a number far away, which changed nothing

  bool operator==(const SequenceCounts&) const = default;
  /// Adds the counts of an earlier run of the sender.
  SequenceCounts& operator+=(const SequenceCounts& more) {
    received += more.received;
    lost += more.lost;
    late += more.late;
    duplicates += more.duplicates;
    restarts += more.restarts;
    strays += more.strays;
    return *this;
  }
};

/// Counts packets by numbers of 1 to 64 bits and follows their wraps; takes 0.4 kB.
/// A number 1024 or more away begins a new count. If the next packet continues the old count, the
/// number was a stray and is undone. A new count that begins less than an hour of packets ahead
/// counts as a loss, not as a restart. A restart less than 1024 numbers back looks like duplicates
/// for 16 packets. A restart ahead of the old count can't be told from a loss.
/// If the caller knows that the sender did not restart, a number 1024 or more away changes nothing.
/// A number behind the newest is then a duplicate, one ahead of it a stray, and no packet counts as
/// lost before it.
class SequenceCount {
 public:
  explicit SequenceCount(unsigned bits = 32);

  /// `may_restart`: false if the caller knows that the packet is older than the newest one, so the
  /// sender did not restart with it.
  Order push(std::uint64_t number, bool may_restart = true);
  const SequenceCounts& counts() const { return now_.counts; }

 private:
  static constexpr std::uint64_t window = 1024;  // numbers behind the newest that are remembered

  struct State {
    SequenceCounts counts;
    std::uint64_t newest = 0;
    std::uint64_t known = 0;     // how many numbers of the window belong to this count
    std::uint64_t previous = 0;  // the number pushed last
    std::uint64_t old_run = 0;   // length of the present run of old numbers that rise by one
    /// A bit for each number of the window, at number % 1024.
    std::array<std::uint64_t, window / 64> seen{};
  };

  /// Steps from `of` up to `number`, with the wrap.
  std::uint64_t ahead(std::uint64_t of, std::uint64_t number) const {
    return (number - of) & mask_;
  }
  /// True if the number lies less than a window before or after the newest one.
  bool near(const State& state, std::uint64_t number) const;
  /// True if a packet with this number arrived. Valid only for numbers within the window.
  bool here(std::uint64_t number) const;
  void mark(std::uint64_t number, bool here);
  void begin(std::uint64_t number);
  void advance(std::uint64_t number);
  /// A number far away: a loss, a restart or a stray.
  Order leap(std::uint64_t number, bool may_restart);
  /// A number behind the newest one: late or old.
  Order look_back(std::uint64_t number, bool may_restart);
  Order old_number(std::uint64_t number, bool may_restart);

  // All numbers are kept modulo 2^bits. Differences are taken with `ahead`, never with < or >, so a
  // wrap needs no case of its own.
  std::uint64_t mask_;
  State now_, before_;
  bool leapt_ = false;  // the last packet began a new count; `before_` is the old one
};

}  // namespace kinalign
