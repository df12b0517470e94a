// SPDX-License-Identifier: Apache-2.0
// What the number that a sender gives each of its packets says of the way here: lost, doubled,
// overtaken, or a sender that began anew. For packets that arrive one by one and are judged at
// once; PacketCount (packet_count.h) gives rows of a file their places.
#pragma once

#include <array>
#include <cstdint>

namespace kinalign {

/// A packet against those that came before it.
enum class Order {
  newest,     // the first of all, the next one, or a later one behind a gap: what lacks is lost
  late,       // overtaken by a newer one; where it was counted as lost, it no longer is
  duplicate,  // its number was here
  stray,      // far ahead, of a sender that has not begun anew: nothing lacks before it
  restart     // the sender counts anew, or so it seems until the next packet: see `strays`
};

struct SequenceCounts {
  std::uint64_t received = 0;  // all that were pushed
  std::uint64_t lost = 0;      // numbers that have not come, from the lowest on that has
  std::uint64_t late = 0;
  std::uint64_t duplicates = 0;
  std::uint64_t restarts = 0;
  std::uint64_t strays = 0;  // numbers far off that changed nothing

  bool operator==(const SequenceCounts&) const = default;
  /// With those of an earlier run of the sender.
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

/// Counts on over the wraps of a number of 1 to 64 bits; takes a fixed room of 0.4 kB.
/// A number 1024 and more away begins a new count; if the packet behind it goes on with the old
/// one, it was a stray and is taken back. A new count that begins less than an hour of packets
/// ahead is no restart but a loss. A restart less than 1024 numbers back looks like duplicates for
/// 16 packets. One that lands ahead of the old count can't be told from a loss.
/// Where the sender has not begun anew, a number 1024 and more away changes nothing, however many
/// come: behind the newest it is a duplicate, ahead of it a stray, and nothing is lost before it.
class SequenceCount {
 public:
  explicit SequenceCount(unsigned bits = 32);

  /// `may_restart`: false where something else says that the packet is older than the newest, so
  /// that the sender has not begun anew by it.
  Order push(std::uint64_t number, bool may_restart = true);
  const SequenceCounts& counts() const { return now_.counts; }

 private:
  static constexpr std::uint64_t window = 1024;  // numbers behind the newest that are remembered

  struct State {
    SequenceCounts counts;
    std::uint64_t newest = 0;
    std::uint64_t known = 0;     // of the window: how many numbers belong to this count
    std::uint64_t previous = 0;  // the last that was pushed
    std::uint64_t old_run = 0;   // numbers that rose one by one where nothing was missed
    std::array<std::uint64_t, window / 64> seen{};  // a bit for each number, by number % 1024
  };

  std::uint64_t ahead(std::uint64_t of, std::uint64_t number) const {
    return (number - of) & mask_;
  }
  bool near(const State& state, std::uint64_t number) const;
  bool here(std::uint64_t number) const;
  void mark(std::uint64_t number, bool here);
  void begin(std::uint64_t number);
  void advance(std::uint64_t number);
  Order leap(std::uint64_t number, bool may_restart);
  Order look_back(std::uint64_t number, bool may_restart);
  Order old_number(std::uint64_t number, bool may_restart);

  std::uint64_t mask_;
  State now_, before_;
  bool leapt_ = false;  // the last one began a count of its own; `before_` is the old one
};

}  // namespace kinalign
