// SPDX-License-Identifier: Apache-2.0
// Receives the BVH broadcast of one sender over TCP or UDP. A connection loses nothing. Datagrams
// may be lost or arrive out of order, so a frame in several datagrams is accepted only if the next
// header shows that no frame is missing: docs/formats/noitom_datagrams.md.
#pragma once

#include "kinalign/protocols/noitom/stream.h"

#include <optional>
#include <vector>

namespace kinalign {

/// Use one receiver for each sender. A connection uses `feed` only; datagrams use `feed_datagram`
/// and, at the end, `finish`.
class NoitomReceiver {
 public:
  explicit NoitomReceiver(NoitomParts parts = NoitomParts::all) : decoder_(parts) {}

  /// Takes bytes of a connection, cut anywhere, as NoitomDecoder::feed does.
  void feed(std::span<const std::uint8_t> bytes, std::vector<NoitomArrival>& out) {
    decoder_.feed(bytes, out);
  }
  /// Takes a datagram, in the order of arrival. A frame in several datagrams is output with its own
  /// arrival time once the next header has arrived, or counted as `incomplete`.
  void feed_datagram(std::span<const std::uint8_t> datagram, HostTime arrival,
                     std::vector<NoitomArrival>& out);
  /// Call at the end. Outputs the last frame if its datagrams arrived together.
  void finish(std::vector<NoitomArrival>& out);
  /// True if `finish` would output a frame.
  bool has_last() const { return cut_ && !after_fault_ && arrived_together(); }

  const NoitomCounts& counts() const { return decoder_.counts(); }
  const std::map<std::uint32_t, NoitomAvatar>& avatars() const { return decoder_.avatars(); }
  /// Bytes kept: never more than 20 kB.
  std::size_t waiting() const { return decoder_.waiting() + (cut_ ? cut_->last_piece.size() : 0); }
  Findings findings(const std::string& name) const;

 private:
  /// A frame in several datagrams. Its last piece stays out of the decoder until the frame is
  /// accepted.
  /// `began` and `ended` are the arrivals of its first and its last piece.
  struct CutFrame {
    NoitomBeginning head;
    HostTime began{}, ended{};
    std::vector<std::uint8_t> last_piece{};  // empty: it has not arrived
  };
  /// True if all pieces have arrived within 4 ms, so that they are of one frame even without a
  /// number.
  bool arrived_together() const;
  bool comes_before(const NoitomFrame& next) const;
  /// Ends the cut frame: outputs it or counts it as incomplete.
  void settle(bool is_whole, std::vector<NoitomArrival>& out);

  NoitomDecoder decoder_;
  std::optional<CutFrame> cut_;  // it waits for its rest, then for the next header
  bool after_fault_ = false;     // the cut frame before this one was dropped
  bool gave_cut_frames_ = false;
};

}  // namespace kinalign
