// SPDX-License-Identifier: Apache-2.0
// Receives the BVH broadcast of one sender over TCP or UDP. TCP delivers all bytes in order.
// Datagrams of UDP may be lost or arrive out of order. A frame in several datagrams is therefore
// accepted only if the next header shows that no frame is missing:
// docs/formats/noitom_datagrams.md.
#pragma once

#include "kinalign/protocols/noitom/stream.h"

#include <optional>
#include <vector>

namespace kinalign {

/// Use one receiver for each sender. For a connection call feed() only. For datagrams call
/// feed_datagram() and, at the end, finish().
class NoitomReceiver {
 public:
  explicit NoitomReceiver(NoitomParts parts = NoitomParts::all) : decoder_(parts) {}

  /// Takes bytes of a connection. They may be cut anywhere, as in NoitomDecoder::feed().
  void feed(std::span<const std::uint8_t> bytes, std::vector<NoitomArrival>& out) {
    decoder_.feed(bytes, out);
  }
  /// Takes a datagram, in the order of arrival. A frame in several datagrams is output after the
  /// next header has arrived, or is counted as `incomplete`. It keeps its own arrival time.
  void feed_datagram(std::span<const std::uint8_t> datagram, HostTime arrival,
                     std::vector<NoitomArrival>& out);
  /// Call this at the end. It outputs the last frame if all its datagrams arrived together.
  void finish(std::vector<NoitomArrival>& out);
  /// True if `finish` would output a frame.
  bool has_last() const { return cut_ && !after_fault_ && arrived_together(); }

  const NoitomCounts& counts() const { return decoder_.counts(); }
  const std::map<std::uint32_t, NoitomAvatar>& avatars() const { return decoder_.avatars(); }
  /// The number of bytes that are kept, at most 20 kB.
  std::size_t waiting() const { return decoder_.waiting() + (cut_ ? cut_->last_piece.size() : 0); }
  Findings findings(const std::string& name) const;

 private:
  /// A frame in several datagrams. The decoder gets its last piece only when the frame is accepted.
  /// `began` and `ended` are the arrivals of its first and last piece.
  struct CutFrame {
    NoitomBeginning head;
    HostTime began{}, ended{};
    std::vector<std::uint8_t> last_piece{};  // empty until it has arrived
  };
  /// True if all pieces arrived within 4 ms. They then belong to one frame, even if it has no
  /// number.
  bool arrived_together() const;
  bool comes_before(const NoitomFrame& next) const;
  /// unproven: the frame may be complete, but the next header does not show it.
  enum class Fate : std::uint8_t { whole, unproven, damaged };
  Fate fate_before(const NoitomFrame& next) const;
  /// Ends the cut frame: outputs it or counts it as incomplete.
  void settle(Fate fate, std::vector<NoitomArrival>& out);

  NoitomDecoder decoder_;
  std::optional<CutFrame> cut_;  // waits for its last piece, then for the next header
  bool after_fault_ = false;     // the cut frame before this one was damaged
  bool gave_cut_frames_ = false;
};

}  // namespace kinalign
