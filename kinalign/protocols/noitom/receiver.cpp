// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/noitom/receiver.h"

#include <utility>

namespace kinalign {

namespace {

// Half of the time between frames of the fastest suits. A sender sends all pieces of one frame
// without a pause, so they arrive closer together.
constexpr Duration longest_spread = std::chrono::milliseconds(4);

std::optional<NoitomHeader> header_of(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < noitom_header_size || !has_noitom_tokens(bytes)) return std::nullopt;
  return parse_noitom_header(bytes);
}

}  // namespace

// A cut frame is a frame in several datagrams. First its head waits in the decoder. Then its last
// piece waits in `cut_`. Then the next datagram decides. If a datagram is longer than the missing
// rest, it belongs to another frame, and the cut frame is dropped.
void NoitomReceiver::feed_datagram(std::span<const std::uint8_t> datagram, HostTime arrival,
                                   std::vector<NoitomArrival>& out) {
  if (datagram.empty()) return;
  const auto header = header_of(datagram);
  if (cut_ && cut_->last_piece.empty() && !header) {
    const std::size_t lacks = cut_->head.size - decoder_.waiting();
    if (datagram.size() < lacks) return decoder_.feed(datagram, out);
    if (datagram.size() == lacks) {
      cut_->last_piece.assign(datagram.begin(), datagram.end());
      cut_->ended = arrival;
      return;
    }
  }
  if (cut_) settle(header ? fate_before(header->frame) : Fate::damaged, out);
  decoder_.feed(datagram, out);
  // No sender splits a frame within its header.
  if (decoder_.waits_within_header()) decoder_.give_up(out);
  if (const auto head = decoder_.beginning()) cut_ = CutFrame{*head, arrival};
}

void NoitomReceiver::finish(std::vector<NoitomArrival>& out) {
  if (has_last()) settle(Fate::whole, out);
}

bool NoitomReceiver::arrived_together() const {
  return !cut_->last_piece.empty() && cut_->ended - cut_->began <= longest_spread;
}

// If a sender has several avatars, their frames have the same number. Without numbers, only the
// arrival times show that the last piece belongs to this frame.
bool NoitomReceiver::comes_before(const NoitomFrame& next) const {
  const NoitomBeginning& head = cut_->head;
  if (!head.index || !next.frame_index) return arrived_together();
  return *next.frame_index - *head.index == (next.avatar > head.avatar ? 0U : 1U);
}

// The cut frame is complete only if the next header continues the frame numbers. If its pieces
// arrived together, none of them is delayed: the sender has left the next number out, or the next
// header is lost.
NoitomReceiver::Fate NoitomReceiver::fate_before(const NoitomFrame& next) const {
  if (!cut_->last_piece.empty() && comes_before(next)) return Fate::whole;
  return arrived_together() ? Fate::unproven : Fate::damaged;
}

// Outputs the cut frame or drops it. After damage the next cut frame is dropped, too, because a
// delayed piece of the first frame may have replaced one of its own pieces.
void NoitomReceiver::settle(Fate fate, std::vector<NoitomArrival>& out) {
  const bool is_after_fault = after_fault_;
  after_fault_ = fate == Fate::damaged || (fate == Fate::unproven && is_after_fault);
  if (fate == Fate::whole && !is_after_fault) {
    const std::size_t before = out.size();
    decoder_.feed(cut_->last_piece, out);
    for (std::size_t i = before; i < out.size(); ++i) out[i].arrival = cut_->ended;
    gave_cut_frames_ = true;
  } else {
    decoder_.give_up(out);
    decoder_.pass_over(cut_->last_piece.size());
  }
  cut_.reset();
}

Findings NoitomReceiver::findings(const std::string& name) const {
  Findings findings = decoder_.findings(name);
  if (gave_cut_frames_) {
    findings.push_back({Severity::note,
                        Error{name, 0, "each frame in one datagram", "frames in several datagrams"},
                        "with each lost datagram up to three frames are lost", "use TCP"});
  }
  return findings;
}

}  // namespace kinalign
