// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/noitom/receiver.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace kinalign {

namespace {

constexpr std::size_t most_counted_avatars = 64;
// Largest step of a sender that occasionally leaves out numbers.
constexpr std::uint32_t longest_skip = 8;
// A missing last piece may arrive late, in the place of the next frame's last piece, which is then
// late itself. So two frames are doubtful.
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
  take_back();
  if (has_last()) give(out);
}

bool NoitomReceiver::has_last() const {
  return !tail_.empty() && newest_ && newest_->spread && pace_.is_in_time(*newest_->spread);
}

// A datagram that equals the one before it is a duplicate. Within a frame it may instead be the
// next piece, if the body does not move.
bool NoitomReceiver::is_repeated(Bytes datagram) const {
  const bool in_the_midst = pieced_ && tail_.empty() && !begins_noitom_header(datagram);
  return !in_the_midst && same(datagram, piece_);
}

// Handles a datagram that continues no frame.
void NoitomReceiver::take_fresh(Bytes datagram, Arrival arrival, Arrivals& out) {
  settle(datagram, arrival, out);
  const std::uint64_t before = trouble();
  const std::size_t given = out.size();
  decoder_.feed(datagram, out);
  // No sender splits a frame within its header.
  if (decoder_.waits_within_header()) decoder_.give_up(out);
  const bool is_odd = trouble() > before;
  if (out.size() > given) release(out, given);  // the next frame is whole in one datagram
  if (!decoder_.beginning()) take_back();
  if (is_odd) {
    doubted_ = std::max(doubted_, 1);
    quiet_ = 0;
  } else if (out.size() > given) {
    doubted_ = 0;
  }
  if (const auto head = decoder_.beginning()) {
    newest_ = Newest{*head, arrival};
    pieced_ = Pieced{*head, {head->held}};
  }
}

// Handles a datagram that should continue the frame in the decoder.
void NoitomReceiver::take_further(Bytes datagram, Arrival arrival, Arrivals& out) {
  const NoitomBeginning& head = pieced_->head;
  Sizes& pieces = pieced_->pieces;
  const std::size_t lacks =
      head.size - std::accumulate(pieces.begin(), pieces.end(), std::size_t{0});
  if (begins_noitom_header(datagram)) {
    take_back();
    drop(out);
    doubted_ = behind_a_lost_end;
    quiet_ = 0;
    return take_fresh(datagram, arrival, out);
  }
  pieces.push_back(std::min(lacks, datagram.size()));
  if (datagram.size() < lacks) return decoder_.feed(datagram, out);
  const bool is_usual = complete(datagram, lacks, arrival);
  if (newest_->ended) release(out, out.size());
  if (!is_usual || doubted_ > 0) {
    drop(out);
    doubted_ = is_usual ? doubted_ - 1 : 1;
  }
  const Bytes rest = datagram.subspan(lacks);
  if (!rest.empty()) take_fresh(rest, arrival, out);
}

// True if the datagram may be the frame's last piece. The delay of a numbered frame is checked
// later, together with the next number.
bool NoitomReceiver::complete(Bytes datagram, std::size_t lacks, Arrival arrival) {
  tail_.assign(datagram.begin(), datagram.begin() + static_cast<std::ptrdiff_t>(lacks));
  tail_arrival_ = arrival;
  const Bytes rest = datagram.subspan(lacks);
  newest_->ended = rest.empty() || begins_noitom_header(rest);
  if (!newest_->ended) {
    quiet_ = 0;
    return false;
  }
  if (arrival && newest_->began) newest_->spread = *arrival - *newest_->began;
  const bool in_time =
      newest_->head.index || !newest_->spread || pace_.is_in_time(*newest_->spread);
  return in_time && cuts_[pieced_->head.size].agrees(pieced_->pieces);
}

// Called at the datagram after a frame in pieces. If no frame is missing between its header and the
// next one, it can't have been completed with another frame's piece.
void NoitomReceiver::settle(Bytes next, Arrival arrival, Arrivals& out) {
  if (!newest_) return;
  const auto header = header_of(next);
  const Follows follows = header ? judge(header->frame) : Follows::no;
  learn(header ? &header->frame : nullptr, arrival);
  if (!tail_.empty() && follows != Follows::no) {
    give(follows == Follows::yes ? out : open_);
  } else if (!tail_.empty()) {
    drop(out);
  }
  if (follows == Follows::no) doubted_ = std::max(doubted_, 1);
  newest_.reset();
}

// Decides by the numbers and by the delay. If nothing was missing recently, one of the two is
// enough.
NoitomReceiver::Follows NoitomReceiver::judge(const NoitomFrame& next) const {
  const auto step = step_to(next);
  if (!step) return newest_->head.index ? Follows::no : Follows::yes;
  static const NoitomSteps unknown;
  const auto found = steps_.find(newest_->head.avatar);
  const NoitomSteps& steps = found == steps_.end() ? unknown : found->second;
  const auto& spread = newest_->spread;
  const bool is_quiet = quiet_ >= quiet_again;
  if (steps.is_whole(*step)) {
    if (!spread || pace_.is_in_time(*spread)) return Follows::yes;
    return is_quiet ? Follows::open : Follows::no;
  }
  if (!spread) return Follows::no;
  if (steps.repeat_with(*step) && pace_.is_in_time(*spread)) return Follows::yes;
  const bool is_skip = step->index <= longest_skip && !(step->avatar == 0 && step->index == 0);
  const bool may_be = steps.is_usual(*step) || (is_skip && is_quiet);
  return may_be && pace_.tells_apart(*spread) ? Follows::yes : Follows::no;
}

/// Difference between the latest header and the next one; empty if one of them has no number.
std::optional<NoitomStep> NoitomReceiver::step_to(const NoitomFrame& next) const {
  const NoitomBeginning& head = newest_->head;
  if (!head.index || !next.frame_index) return std::nullopt;
  return NoitomStep{next.avatar - head.avatar, *next.frame_index - *head.index};
}

// Learns from each frame in pieces, dropped ones too. `next`: the header after the newest one;
// null: another piece follows.
void NoitomReceiver::learn(const NoitomFrame* next, Arrival arrival) {
  const bool is_plain = next != nullptr && newest_->ended;
  if (is_plain && newest_->spread && arrival)
    pace_.push(*newest_->spread, *arrival - *newest_->began);
  if (next != nullptr && quiet_ < quiet_again) ++quiet_;
  const std::uint32_t avatar = newest_->head.avatar;
  if (!newest_->head.index || (steps_.size() == most_counted_avatars && !steps_.contains(avatar)))
    return;
  steps_[avatar].push(is_plain ? step_to(*next) : std::nullopt);
}

/// Completes the frame in the decoder with its last piece and outputs it.
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

// Outputs the frame kept in open_: the last piece of the next frame has arrived after its header.
void NoitomReceiver::release(Arrivals& out, std::size_t at) {
  out.insert(out.begin() + static_cast<std::ptrdiff_t>(at), open_.begin(), open_.end());
  open_.clear();
}

// Drops the frame kept in open_: the next frame's last piece has not arrived, so it may be the
// piece that completed this frame.
void NoitomReceiver::take_back() {
  for (const NoitomArrival& one : open_) {
    decoder_.take_back(one.frame);
    --in_pieces_;
  }
  open_.clear();
}

// Drops the frame: it counts as torn, and its possible last piece belongs to no frame.
void NoitomReceiver::drop(Arrivals& out) {
  decoder_.give_up(out);
  decoder_.pass_over(tail_.size());
  tail_.clear();
  pieced_.reset();
}

/// A number that grows with every refusal and every skipped byte.
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
