// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/bvh/rows.h"

#include "kinalign/core/numbers.h"
#include "kinalign/formats/named_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kinalign {

namespace {

constexpr std::size_t longest_word = 512;

}  // namespace

bool BvhRowRule::line_end(std::uint64_t values, std::int64_t line) {
  const std::uint64_t in_line = values - line_start_;
  // Blank lines are ignored.
  if (in_line == 0) return true;
  const std::uint64_t before = line_start_ % row_size_;
  if (!judged_) {
    judged_ = true;
    strict_ = in_line % row_size_ == 0;
  }
  // This line begins within a frame and ends behind the frame's end.
  if (strict_ && before != 0 && before + in_line > row_size_) return false;
  if (before == 0) {
    // This line may be the one that shifts all others, so its number is kept for the message.
    shift_line_ = line;
    shift_values_ = in_line;
  }
  line_start_ = values;
  return true;
}

Result<void> BvhRows::feed(std::string_view piece, Findings& findings) {
  if (ended_) return {};
  if (!carry_.empty()) {
    // The word from the last piece ends at the first blank.
    std::size_t end = 0;
    while (end < piece.size() && !is_blank(piece[end])) ++end;
    if (end == piece.size() || carry_.size() + end > longest_word) return hold(piece);
    carry_ += piece.substr(0, end + 1);
    piece.remove_prefix(end + 1);
    const std::string word = std::move(carry_);
    carry_.clear();
    KA_TRY(parse(word.data(), word.data() + word.size(), findings));
    if (ended_) return {};
  }
  std::size_t end = piece.size();
  // The last word may continue in the next piece.
  while (end > 0 && !is_blank(piece[end - 1])) --end;
  KA_TRY(parse(piece.data(), piece.data() + end, findings));
  return ended_ ? Result<void>{} : hold(piece.substr(end));
}

Result<void> BvhRows::finish(Findings& findings) {
  // If the file ends with a number, the file may be truncated and the number may have lost digits.
  if (!carry_.empty() && !ended_) findings.push_back(unended_finding(head_.name, head_.line));
  KA_TRY(feed("\n", findings));  // the line feed ends the last number
  const std::size_t left = count_ % head_.row_size;
  if (left == 0) return {};
  add_warning(findings,
              {head_.name, head_.line - 1, fmt::format("{} values in the frame", head_.row_size),
               std::to_string(left)},
              "the incomplete last frame was dropped");
  return {};
}

// Removes the complete frames. The values of the incomplete frame move to the front.
void BvhRows::drop_frames() {
  const std::size_t whole = frames().size();
  std::copy(values_.begin() + static_cast<std::ptrdiff_t>(whole),
            values_.begin() + static_cast<std::ptrdiff_t>(count_), values_.begin());
  dropped_ += whole / head_.row_size;
  count_ -= whole;
}

/// Keeps the beginning of a word until the next piece.
Result<void> BvhRows::hold(std::string_view word) {
  // One byte more than the limit is kept, so that the check below notices a too long word.
  carry_ += word.substr(0, longest_word + 1);
  if (carry_.size() <= longest_word) return {};
  return Failure(wrong_number(carry_));
}

Error BvhRows::wrong_number(std::string_view word) const {
  return Error{head_.name, head_.line, "a number", "'" + shown(word) + "'"};
}

bool BvhRows::end_line(std::size_t count) {
  return rule_.line_end(dropped_ * head_.row_size + count, head_.line++);
}

// Parses the numbers in [at, end). The text ends with a blank, so that the last number is complete.
Result<void> BvhRows::parse(const char* at, const char* end, Findings& findings) {
  // A number and its blank need at least two bytes. With this size the loop need not check the
  // space.
  const std::size_t most = count_ + static_cast<std::size_t>(end - at) / 2 + 1;
  if (values_.size() < most) values_.resize(most);
  double* out = values_.data() + count_;
  // count_ is updated only at the end of this function.
  const auto count = [&] { return static_cast<std::size_t>(out - values_.data()); };
  for (;;) {
    for (; at < end && is_blank(*at); ++at) {
      if (*at == '\n' && !end_line(count())) {
        return Failure(Error{head_.name, rule_.shift_line(),
                             fmt::format("{} values in the frame", head_.row_size),
                             std::to_string(rule_.shift_values())});
      }
    }
    if (at >= end) break;
    const char* behind = parse_number(at, end, *out);
    // A blank must follow the number, so "1.2.3" is not a number.
    if (behind == nullptr || !is_blank(*behind) || !(std::abs(*out) < largest_number)) {
      count_ = count();
      return strange_word(at, end, findings);
    }
    if (count_decimals) {
      const std::string_view word(at, static_cast<std::size_t>(behind - at));
      decimals_ = std::max(decimals_, decimals_of(word));
    }
    ++out;
    at = behind;
  }
  count_ = count();
  return {};
}

/// Handles a word that is not a number. It is a finding if all stated frames are read, otherwise an
/// error.
Result<void> BvhRows::strange_word(const char* at, const char* end, Findings& findings) {
  const char* behind = at;
  while (behind < end && !is_blank(*behind)) ++behind;
  const std::string_view word(at, static_cast<std::size_t>(behind - at));
  // Some programs write notes after the rows. The notes do no harm if all stated frames are read.
  if (frames_read() < head_.frames || count_ % head_.row_size != 0 || head_.frames == 0) {
    return Failure(wrong_number(word));
  }
  add_warning(findings, {head_.name, head_.line, "the end of the file", "'" + shown(word) + "'"},
              "all rows from this line on were left out");
  ended_ = true;
  return {};
}

Result<void> BvhValues::feed(std::string_view piece, Findings& findings) {
  if (rows_) return rows_->feed(piece, findings);
  return KA_TRY(head_.add(piece, findings)) ? begin_rows(findings) : Result<void>();
}

Result<void> BvhValues::finish(Findings& findings) {
  if (!rows_) {
    KA_TRY(head_.finish(findings));
    KA_TRY(begin_rows(findings));
  }
  KA_TRY(rows_->finish(findings));
  if (frames_read() == head_.hierarchy.frames) return {};
  add_warning(findings,
              {name_, head_.hierarchy.frames_line, fmt::format("{} frames", head_.hierarchy.frames),
               std::to_string(frames_read())},
              "the existing frames were read");
  return {};
}

/// values_ calls this when the head is complete. The text after the head contains the rows.
Result<void> BvhValues::begin_rows(Findings& findings) {
  const BvhHierarchy& hierarchy = head_.hierarchy;
  // In this call the reader prepares its poser, before the first row arrives.
  if (on_head_) on_head_(hierarchy);
  const std::size_t row_size = hierarchy.row_size();
  if (row_size == 0) {
    return Failure(Error{name_, hierarchy.frames_line, "at least one channel", "none"});
  }
  rows_.emplace(BvhRowsHead{name_, row_size, hierarchy.frames, head_.first_row_line()});
  rows_->count_decimals = count_decimals;
  // The piece that completes the head may contain rows, too.
  KA_TRY(rows_->feed(head_.rows(), findings));
  head_.forget_text();
  return {};
}

}  // namespace kinalign
