// SPDX-License-Identifier: Apache-2.0
#include "kinalign/io/noitom_receiver.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace kinalign {

namespace {

// Pieces of one frame are sent back to back. The fastest suits send a frame each 8 ms: what comes
// later than half of that may as well be the next one's.
constexpr Duration longest_spread = std::chrono::milliseconds(4);
constexpr std::size_t longest_piece = 2048;  // no frame is longer
constexpr std::size_t most_avatars = 64;
// An end that did not come may be late, and come in the place of the next one's, which is then late
// itself.
constexpr int behind_a_lost_end = 2;

bool same(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

std::optional<NoitomHeader> header_of(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < noitom_header_size || !has_noitom_tokens(bytes)) return std::nullopt;
  return parse_noitom_header(bytes);
}

}  // namespace

void NoitomReceiver::feed_datagram(Bytes datagram, Arrival arrival, Arrivals& out) {
  if (datagram.empty() || is_repeated(datagram)) return;
  const bool goes_on = pieced_ && tail_.empty();
  if (goes_on) {
    take_further(datagram, arrival, out);
  } else {
    take_fresh(datagram, arrival, out);
  }
  piece_.clear();
  const bool is_piece = goes_on || pieced_;
  if (is_piece && datagram.size() <= longest_piece) piece_.assign(datagram.begin(), datagram.end());
}

void NoitomReceiver::finish(Arrivals& out) {
  if (!tail_.empty() && tail_arrival_) give(out);
}

// What comes twice at once was doubled on its way. In the midst of a frame it may be the next
// piece, which is as still as the one before.
bool NoitomReceiver::is_repeated(Bytes datagram) const {
  const bool in_the_midst = pieced_ && tail_.empty() && !begins_noitom_header(datagram);
  return !in_the_midst && same(datagram, piece_);
}

// What continues no frame.
void NoitomReceiver::take_fresh(Bytes datagram, Arrival arrival, Arrivals& out) {
  settle(datagram, out);
  const std::uint64_t before = trouble();
  const std::size_t given = out.size();
  decoder_.feed(datagram, out);
  if (decoder_.waits_within_header()) decoder_.give_up(out);  // no sender cuts there
  const bool is_odd = trouble() > before;
  if (is_odd) {
    doubted_ = std::max(doubted_, 1);
  } else if (out.size() > given) {
    doubted_ = 0;
  }
  if (const auto head = decoder_.beginning()) {
    newest_ = head;
    pieced_ = Pieced{*head, {head->held}, arrival};
  }
}

// What should continue the frame that waits in the decoder.
void NoitomReceiver::take_further(Bytes datagram, Arrival arrival, Arrivals& out) {
  const NoitomBeginning& head = pieced_->head;
  Sizes& pieces = pieced_->pieces;
  const std::size_t lacks =
      head.size - std::accumulate(pieces.begin(), pieces.end(), std::size_t{0});
  if (begins_noitom_header(datagram)) {
    drop(out);
    doubted_ = behind_a_lost_end;
    return take_fresh(datagram, arrival, out);
  }
  pieces.push_back(std::min(lacks, datagram.size()));
  if (datagram.size() < lacks) return decoder_.feed(datagram, out);
  const Bytes rest = datagram.subspan(lacks);
  const bool ends_well = rest.empty() || begins_noitom_header(rest);
  const bool in_time = !arrival || !pieced_->began || *arrival - *pieced_->began <= longest_spread;
  const bool is_usual = ends_well && in_time && cuts_[head.size].agrees(pieces);
  tail_.assign(datagram.begin(), datagram.begin() + static_cast<std::ptrdiff_t>(lacks));
  tail_arrival_ = arrival;
  if (!is_usual || doubted_ > 0) {
    drop(out);
    doubted_ = is_usual ? doubted_ - 1 : 1;
  }
  if (!rest.empty()) take_fresh(rest, arrival, out);
}

// Behind a frame in pieces. Where no frame is missing between its header and this one, it can't
// have been completed with another one's piece.
void NoitomReceiver::settle(Bytes next, Arrivals& out) {
  if (!newest_) return;
  const auto header = header_of(next);
  const bool follows = header && is_next(*header);
  if (!tail_.empty() && follows) {
    give(out);
  } else if (!tail_.empty()) {
    drop(out);
  }
  if (!follows) doubted_ = std::max(doubted_, 1);
  if (header) newest_.reset();
}

bool NoitomReceiver::is_next(const NoitomHeader& next) {
  if (!newest_->index) return true;
  if (!next.frame.frame_index) return false;
  const std::uint32_t avatar = newest_->avatar;
  if (steps_.size() == most_avatars && !steps_.contains(avatar)) return false;
  const Step step{next.frame.avatar - avatar, *next.frame.frame_index - *newest_->index};
  const auto known = steps_.try_emplace(avatar, steps_of_a_habit, Step()).first;
  return known->second.agrees(step);
}

void NoitomReceiver::give(Arrivals& out) {
  const std::uint64_t before = trouble();
  const std::size_t given = out.size();
  decoder_.feed(tail_, out);
  if (trouble() > before) doubted_ = 1;
  for (std::size_t i = given; i < out.size(); ++i) out[i].arrival = tail_arrival_;
  in_pieces_ += out.size() - given;
  if (out.size() > given) most_pieces_ = std::max(most_pieces_, pieced_->pieces.size());
  tail_.clear();
  pieced_.reset();
}

// It is torn, and what may be its end is nobody's.
void NoitomReceiver::drop(Arrivals& out) {
  decoder_.give_up(out);
  decoder_.pass_over(tail_.size());
  tail_.clear();
  pieced_.reset();
}

std::uint64_t NoitomReceiver::trouble() const {
  const auto& refused = decoder_.counts().refused;
  return std::accumulate(refused.begin(), refused.end(), decoder_.counts().bytes_skipped);
}

Findings NoitomReceiver::findings(const std::string& name) const {
  Findings findings = decoder_.findings(name);
  if (in_pieces_ > 0) {
    findings.push_back({Severity::note,
                        Error{name, 0, "each frame in one datagram",
                              fmt::format("frames in {} datagrams each", most_pieces_)},
                        most_pieces_ == 2
                            ? "with each one a frame is lost"
                            : "with each one a frame is lost, and where some of a frame's overtake "
                              "each other its values are mixed unseen",
                        "prefer TCP"});
  }
  return findings;
}

}  // namespace kinalign
