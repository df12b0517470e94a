// SPDX-License-Identifier: Apache-2.0
// One sender of the BVH broadcast, over either transport. A connection loses nothing; of datagrams
// some are lost, overtaken or cut short, and a frame in several of them is believed only where
// nothing speaks against it. The rules: docs/formats/noitom_stream.md, "Frames in several
// datagrams".
#pragma once

#include "kinalign/protocols/noitom/habits.h"
#include "kinalign/protocols/noitom/stream.h"

#include <optional>
#include <vector>

namespace kinalign {

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
  /// Whether `finish` would give one.
  bool has_last() const;

  const NoitomCounts& counts() const { return decoder_.counts(); }
  const std::map<std::uint32_t, NoitomAvatar>& avatars() const { return decoder_.avatars(); }
  /// Bytes that wait: never more than 20 kB, and of datagrams three of a frame's size.
  std::size_t waiting() const {
    return decoder_.waiting() + tail_.size() + piece_.size() + open_.size() * longest_piece;
  }
  Findings findings(const std::string& name) const;

 private:
  using Bytes = std::span<const std::uint8_t>;
  using Sizes = std::vector<std::size_t>;
  using Arrival = std::optional<HostTime>;
  using Arrivals = std::vector<NoitomArrival>;
  /// A frame that began in a datagram and did not end there.
  struct Pieced {
    NoitomBeginning head;
    Sizes pieces{};
  };

  /// A header in pieces, until the next one has come.
  struct Newest {
    NoitomBeginning head;
    std::optional<HostTime> began{};
    bool ended = false;                // behind it came its end, or what may be its end
    std::optional<Duration> spread{};  // from its first piece to its last
  };

  /// Whether two headers are of frames one behind the other: the end between them is then the
  /// first one's. Open: it is, unless the second one's came before its header and gets lost here.
  enum class Follows { no, open, yes };

  static constexpr std::size_t longest_piece = 2048;  // no frame is longer
  // About a second.
  static constexpr int quiet_again = 100;

  bool is_repeated(Bytes datagram) const;
  void take_fresh(Bytes datagram, Arrival arrival, Arrivals& out);
  void take_further(Bytes datagram, Arrival arrival, Arrivals& out);
  bool complete(Bytes datagram, std::size_t lacks, Arrival arrival);
  void settle(Bytes next, Arrival arrival, Arrivals& out);
  Follows judge(const NoitomFrame& next) const;
  std::optional<NoitomStep> step_to(const NoitomFrame& next) const;
  void learn(const NoitomFrame* next, Arrival arrival);
  void give(Arrivals& out);
  void release(Arrivals& out, std::size_t at);
  void take_back();
  void drop(Arrivals& out);
  std::uint64_t trouble() const;

  NoitomDecoder decoder_;
  std::optional<Pieced> pieced_;
  std::optional<Newest> newest_;
  std::vector<std::uint8_t> tail_;  // that completes it: it waits for the next header
  Arrival tail_arrival_;
  Arrivals open_;                    // a frame that waits for the next one's end
  std::vector<std::uint8_t> piece_;  // the last datagram, if it was one
  int doubted_ = 0;  // frames in pieces that are dropped, since something odd stood before them
  int quiet_ = quiet_again;                     // headers since a piece was missing
  std::map<std::size_t, Habit<Sizes>> cuts_;    // by a frame's size, of which there are four
  std::map<std::uint32_t, NoitomSteps> steps_;  // by avatar
  NoitomPace pace_;
  std::uint64_t in_pieces_ = 0;  // frames that were given
  std::size_t most_pieces_ = 0;  // of one
};

}  // namespace kinalign
