// SPDX-License-Identifier: Apache-2.0
// Parses the numbers of a BVH from pieces cut anywhere: the rows alone (BvhRows), or the head and
// the rows (BvhValues).
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/formats/bvh/head.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// Compares the ends of lines with the ends of frames, both counted in values.
/// In many files each frame is one line. Then a line with a number too many or too few is a fault,
/// since all frames after it would be shifted. In other files rows are wrapped or joined, and lines
/// mean nothing.
class BvhRowRule {
 public:
  explicit BvhRowRule(std::size_t row_size) : row_size_(row_size) {}

  /// Call at the end of each line, with the number of values so far. False if all frames from
  /// shift_line() on are shifted: that line does not end with its frame, and neither does this one.
  bool line_end(std::uint64_t values, std::int64_t line);

  // The line that shifts the frames, and the number of its values.
  std::int64_t shift_line() const { return shift_line_; }
  std::uint64_t shift_values() const { return shift_values_; }

 private:
  std::size_t row_size_;
  std::uint64_t line_start_ = 0;  // values before the current line
  bool judged_ = false;           // the first line has been seen
  bool strict_ = false;           // the first line held whole frames
  std::int64_t shift_line_ = 0;
  std::uint64_t shift_values_ = 0;
};

/// Start of a file's rows, and the size and number of frames that its head promises.
struct BvhRowsHead {
  std::string name;          // the file's name, for messages
  std::size_t row_size = 0;  // values in a frame
  std::uint64_t frames = 0;  // promised
  std::int64_t line = 1;     // line on which the rows begin
};

/// values_ keeps its size when frames are dropped, so its memory is allocated once. Numbers are
/// parsed straight into it.
class BvhRows {
 public:
  explicit BvhRows(BvhRowsHead head) : head_(std::move(head)), rule_(head_.row_size) {}

  /// Parses all numbers that end in the piece; the last word waits for its end. Fails at a word
  /// that is no number. If all promised frames came before that word, it is only a finding.
  Result<void> feed(std::string_view piece, Findings& findings);
  /// Call at the end of the file. An incomplete last frame is a finding.
  Result<void> finish(Findings& findings);

  /// The whole frames [n, row_size] that have not been dropped yet.
  std::span<const double> frames() const {
    return {values_.data(), count_ / head_.row_size * head_.row_size};
  }
  void drop_frames();

  std::uint64_t frames_read() const { return dropped_ + count_ / head_.row_size; }
  int decimals() const { return decimals_; }  // most digits behind a point, if count_decimals
  bool count_decimals = false;

 private:
  Result<void> parse(const char* at, const char* end, Findings& findings);
  Result<void> strange_word(const char* at, const char* end, Findings& findings);
  Result<void> hold(std::string_view word);
  Error wrong_number(std::string_view word) const;
  bool end_line(std::size_t count);

  BvhRowsHead head_;
  BvhRowRule rule_;
  std::string carry_;           // a word cut by the end of a piece
  std::vector<double> values_;  // capacity; the first count_ elements are values
  std::size_t count_ = 0;
  std::uint64_t dropped_ = 0;  // frames
  bool ended_ = false;         // all further text is ignored, because it is no number
  int decimals_ = 0;
};

/// Joins head and rows: pieces go to head_ until it is complete, then to rows_.
class BvhValues {
 public:
  /// `on_head` is called once, with the hierarchy, before the first row is parsed.
  using OnHead = std::function<void(const BvhHierarchy&)>;

  explicit BvhValues(std::string name, OnHead on_head = {})
      : name_(std::move(name)), on_head_(std::move(on_head)), head_(name_) {}

  Result<void> feed(std::string_view piece, Findings& findings);
  /// Call at the end of the file. A number of frames other than the promised one is a finding.
  Result<void> finish(Findings& findings);

  bool has_rows() const { return rows_.has_value(); }
  BvhHierarchy& hierarchy() { return head_.hierarchy; }
  /// The complete frames that have not been dropped yet, values [n,C].
  std::span<const double> frames() const {
    return rows_ ? rows_->frames() : std::span<const double>();
  }
  void drop_frames() {
    if (rows_) rows_->drop_frames();
  }
  std::uint64_t frames_read() const { return rows_ ? rows_->frames_read() : 0; }
  int decimals() const { return rows_ ? rows_->decimals() : 0; }  // if count_decimals
  bool count_decimals = false;

 private:
  Result<void> begin_rows(Findings& findings);

  std::string name_;
  OnHead on_head_;
  BvhHead head_;
  std::optional<BvhRows> rows_;
};

}  // namespace kinalign
