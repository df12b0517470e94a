// SPDX-License-Identifier: Apache-2.0
// Receives the BVH broadcast of one sender over TCP or UDP. A connection loses nothing. Datagrams
// may be lost, delayed or truncated, so a frame in several datagrams is accepted only if nothing
// contradicts it. The rules: docs/formats/noitom_stream.md, "Frames in several datagrams".
#pragma once

#include "kinalign/protocols/noitom/habits.h"
#include "kinalign/protocols/noitom/stream.h"

#include <optional>
#include <vector>

namespace kinalign {

class NoitomReceiver {
 public:
  explicit NoitomReceiver(NoitomParts parts = NoitomParts::all) : decoder_(parts) {}

  /// Takes bytes of a connection, cut anywhere, as NoitomDecoder::feed does.
  void feed(std::span<const std::uint8_t> bytes, std::vector<NoitomArrival>& out) {
    decoder_.feed(bytes, out);
  }
  /// Takes a datagram, in the order of arrival. A frame of several datagrams is output once the
  /// next header has arrived, with its own arrival time if that is known. A doubtful frame is
  /// counted as `torn`.
  void feed_datagram(std::span<const std::uint8_t> datagram, std::optional<HostTime> arrival,
                     std::vector<NoitomArrival>& out);
  /// Call at the end. A frame that waits for the next header is output if its arrival time supports
  /// it.
  void finish(std::vector<NoitomArrival>& out);
  /// True if `finish` would output a frame.
  bool has_last() const;

  const NoitomCounts& counts() const { return decoder_.counts(); }
  const std::map<std::uint32_t, NoitomAvatar>& avatars() const { return decoder_.avatars(); }
  /// Bytes kept: never more than 20 kB, and with datagrams three times the size of a frame.
  std::size_t waiting() const {
    return decoder_.waiting() + tail_.size() + piece_.size() + open_.size() * longest_piece;
  }
  Findings findings(const std::string& name) const;

 private:
  using Bytes = std::span<const std::uint8_t>;
  using Sizes = std::vector<std::size_t>;
  using Arrival = std::optional<HostTime>;
  using Arrivals = std::vector<NoitomArrival>;
  /// A frame that began in one datagram and did not end there, with the sizes of its pieces.
  struct Pieced {
    NoitomBeginning head;
    Sizes pieces{};
  };

  /// The latest header of a frame in pieces, until the next header has arrived.
  struct Newest {
    NoitomBeginning head;
    std::optional<HostTime> began{};
    bool ended = false;  // its last piece, or a datagram that may be it, came after it
    std::optional<Duration> spread{};  // delay from its first piece to its last
  };

  /// Tells whether the next header belongs to the frame after this one; the last piece between them
  /// is then this frame's. Open: it does, unless the next frame's last piece arrived before its
  /// header and is then lost.
  enum class Follows { no, open, yes };

  static constexpr std::size_t longest_piece = 2048;  // no frame is longer
  // Headers without a missing piece after which the link counts as undisturbed: about a second.
  static constexpr int quiet_again = 100;

  bool is_repeated(Bytes datagram) const;
  /// Handles a datagram that does not continue a frame.
  void take_fresh(Bytes datagram, Arrival arrival, Arrivals& out);
  void take_further(Bytes datagram, Arrival arrival, Arrivals& out);
  bool complete(Bytes datagram, std::size_t lacks, Arrival arrival);
  void settle(Bytes next, Arrival arrival, Arrivals& out);
  /// Compares numbers and delays of the latest header and the next one.
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
  std::vector<std::uint8_t> tail_;  // last piece of the frame, which waits for the next header
  Arrival tail_arrival_;
  Arrivals open_;                    // a frame that waits for the last piece of the next one
  std::vector<std::uint8_t> piece_;  // the last datagram, if it was a piece of a frame
  int doubted_ = 0;  // number of frames in pieces that must be dropped, because the data before
                     // them was faulty
  int quiet_ = quiet_again;                     // headers since a piece was missing
  std::map<std::size_t, Habit<Sizes>> cuts_;    // usual cuts, for each of the four sizes of a frame
  std::map<std::uint32_t, NoitomSteps> steps_;  // for each avatar
  NoitomPace pace_;
  std::uint64_t in_pieces_ = 0;  // frames in pieces that were output
  std::size_t most_pieces_ = 0;  // largest number of pieces of a frame
};

}  // namespace kinalign
