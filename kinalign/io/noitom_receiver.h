// SPDX-License-Identifier: Apache-2.0
// One sender of the BVH broadcast, over either transport. A connection loses nothing; of datagrams
// some are lost, overtaken or cut short, and a frame in several of them is believed only where
// nothing speaks against it. The rules: docs/formats/noitom_stream.md, "Frames in several
// datagrams".
#pragma once

#include "kinalign/io/noitom_stream.h"

#include <optional>
#include <utility>

namespace kinalign {

/// What is always the same, until it is another way `times` running. The first one is as usual
/// where none was known.
template <class Value>
class Habit {
 public:
  explicit Habit(int times = 2, std::optional<Value> usual = std::nullopt)
      : times_(times), usual_(std::move(usual)) {}

  /// Whether it is as usual.
  bool agrees(const Value& seen) {
    running_ = lately_ == seen ? running_ + 1 : 1;
    lately_ = seen;
    if (!usual_ || running_ >= times_) usual_ = seen;
    return usual_ == seen;
  }

 private:
  int times_, running_ = 0;
  std::optional<Value> usual_, lately_;
};

class NoitomReceiver {
 public:
  explicit NoitomReceiver(NoitomParts parts = NoitomParts::all) : decoder_(parts) {}

  /// Bytes of a connection, cut anywhere: NoitomDecoder::feed.
  void feed(std::span<const std::uint8_t> bytes, std::vector<NoitomArrival>& out) {
    decoder_.feed(bytes, out);
  }
  /// A datagram, in the order of arrival. A frame of several is given when the next header
  /// has come, with its own arrival where that is known; what is doubtful is `torn`.
  void feed_datagram(std::span<const std::uint8_t> datagram, std::optional<HostTime> arrival,
                     std::vector<NoitomArrival>& out);
  /// Nothing follows: a frame that waits for the next header is given, if its arrival speaks for
  /// it.
  void finish(std::vector<NoitomArrival>& out);

  const NoitomCounts& counts() const { return decoder_.counts(); }
  const std::map<std::uint32_t, NoitomAvatar>& avatars() const { return decoder_.avatars(); }
  /// Bytes that wait: never more than 20 kB, and of datagrams two of a frame's size.
  std::size_t waiting() const { return decoder_.waiting() + tail_.size() + piece_.size(); }
  Findings findings(const std::string& name) const;

 private:
  using Bytes = std::span<const std::uint8_t>;
  using Sizes = std::vector<std::size_t>;
  using Arrival = std::optional<HostTime>;
  using Arrivals = std::vector<NoitomArrival>;
  /// From a header to the next one's.
  struct Step {
    std::uint32_t avatar = 0, index = 1;  // how much more
    bool operator==(const Step&) const = default;
  };
  /// A frame that began in a datagram and did not end there.
  struct Pieced {
    NoitomBeginning head;
    Sizes pieces{};
    std::optional<HostTime> began{};
  };

  // Two losses of a frame alike are nothing rare.
  static constexpr int steps_of_a_habit = 4;

  bool is_repeated(Bytes datagram) const;
  void take_fresh(Bytes datagram, Arrival arrival, Arrivals& out);
  void take_further(Bytes datagram, Arrival arrival, Arrivals& out);
  void settle(Bytes next, Arrivals& out);
  bool is_next(const NoitomHeader& next);
  void give(Arrivals& out);
  void drop(Arrivals& out);
  std::uint64_t trouble() const;

  NoitomDecoder decoder_;
  std::optional<Pieced> pieced_;
  std::optional<NoitomBeginning> newest_;  // header, until the next one has come
  std::vector<std::uint8_t> tail_;         // that completes it: it waits for the next header
  Arrival tail_arrival_;
  std::vector<std::uint8_t> piece_;  // the last datagram, if it was one
  int doubted_ = 0;  // frames in pieces that are dropped, since something odd stood before them
  std::map<std::size_t, Habit<Sizes>> cuts_;    // by a frame's size, of which there are four
  std::map<std::uint32_t, Habit<Step>> steps_;  // by avatar
  std::uint64_t in_pieces_ = 0;                 // frames that were given
  std::size_t most_pieces_ = 0;                 // of one
};

}  // namespace kinalign
