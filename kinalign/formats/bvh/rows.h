// SPDX-License-Identifier: Apache-2.0
// Parses the numbers of a BVH file from pieces, which may be cut anywhere. BvhRows parses only
// rows, and BvhValues parses head and rows.
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

/// Compares the ends of lines with the ends of frames; both are numbers of values. In many files
/// each frame is one line. A line with too many or too few numbers is then a fault, because it
/// shifts all following frames. In other files the lines do not correspond to frames, and this rule
/// is not applied.
class BvhRowRule {
 public:
  explicit BvhRowRule(std::size_t row_size) : row_size_(row_size) {}

  /// Call this at the end of each line, with the number of values so far. Returns false if neither
  /// shift_line() nor this line ends at the end of a frame: all frames from shift_line() on are
  /// shifted.
  bool line_end(std::uint64_t values, std::int64_t line);

  // The line that shifts the frames, and the number of values in it.
  std::int64_t shift_line() const { return shift_line_; }
  std::uint64_t shift_values() const { return shift_values_; }

 private:
  std::size_t row_size_;
  std::uint64_t line_start_ = 0;  // number of values before the current line
  bool judged_ = false;           // true after the first line
  bool strict_ = false;           // true if the first line consisted of whole frames
  std::int64_t shift_line_ = 0;
  std::uint64_t shift_values_ = 0;
};

/// The start of a file's rows, and the row size and frame count in its head.
struct BvhRowsHead {
  std::string name;          // the file's name, for messages
  std::size_t row_size = 0;  // number of values in a frame
  std::uint64_t frames = 0;  // number of frames that the head states
  std::int64_t line = 1;     // line on which the rows begin
};

/// Parses rows. Numbers are parsed directly into values_. values_ does not shrink when frames are
/// removed, so its memory is allocated once.
class BvhRows {
 public:
  explicit BvhRows(BvhRowsHead head) : head_(std::move(head)), rule_(head_.row_size) {}

  /// Parses all numbers that end in the piece. The last word waits for its end. A word that is not
  /// a number is an error, or a finding if all stated frames come before it.
  Result<void> feed(std::string_view piece, Findings& findings);
  /// Call this at the end of the file. An incomplete last frame is a finding.
  Result<void> finish(Findings& findings);

  /// The complete frames [n, row_size] that have not been removed yet.
  std::span<const double> frames() const {
    return {values_.data(), count_ / head_.row_size * head_.row_size};
  }
  void drop_frames();

  std::uint64_t frames_read() const { return dropped_ + count_ / head_.row_size; }
  int decimals() const { return decimals_; }  // largest number of decimals, if count_decimals
  bool count_decimals = false;

 private:
  Result<void> parse(const char* at, const char* end, Findings& findings);
  Result<void> strange_word(const char* at, const char* end, Findings& findings);
  Result<void> hold(std::string_view word);
  Error wrong_number(std::string_view word) const;
  bool end_line(std::size_t count);

  BvhRowsHead head_;
  BvhRowRule rule_;
  std::string carry_;           // a word that the end of a piece cuts
  std::vector<double> values_;  // only the first count_ elements are values
  std::size_t count_ = 0;
  std::uint64_t dropped_ = 0;  // number of removed frames
  bool ended_ = false;         // true after a note: all further text is ignored
  int decimals_ = 0;
};

/// Joins head and rows. Pieces go to head_ until the head is complete, and then to rows_.
class BvhValues {
 public:
  /// `on_head` is called once with the hierarchy, before the first row is parsed.
  using OnHead = std::function<void(const BvhHierarchy&)>;

  explicit BvhValues(std::string name, OnHead on_head = {})
      : name_(std::move(name)), on_head_(std::move(on_head)), head_(name_) {}

  Result<void> feed(std::string_view piece, Findings& findings);
  /// Call this at the end of the file. A wrong number of frames is a finding.
  Result<void> finish(Findings& findings);

  bool has_rows() const { return rows_.has_value(); }
  BvhHierarchy& hierarchy() { return head_.hierarchy; }
  /// The complete frames that have not been removed yet, values [n,C].
  std::span<const double> frames() const {
    return rows_ ? rows_->frames() : std::span<const double>();
  }
  void drop_frames() {
    if (rows_) rows_->drop_frames();
  }
  std::uint64_t frames_read() const { return rows_ ? rows_->frames_read() : 0; }
  int decimals() const { return rows_ ? rows_->decimals() : 0; }  // valid if count_decimals
  bool count_decimals = false;

 private:
  Result<void> begin_rows(Findings& findings);

  std::string name_;
  OnHead on_head_;
  BvhHead head_;
  std::optional<BvhRows> rows_;
};

}  // namespace kinalign
