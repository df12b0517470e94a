// SPDX-License-Identifier: Apache-2.0
// Splits a text into lines. The text arrives in pieces, which may be cut anywhere.
#pragma once

#include "kinalign/core/error.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace kinalign {

class LineSplitter {
 public:
  static constexpr std::size_t longest = std::size_t{1} << 20;

  /// Calls `use(line)` -> Result<void> for each line that `piece` completes. The line is passed
  /// without its line end (a line feed, or carriage return and line feed). During the call number()
  /// is the line's number, counted from 1. The character after the line is readable and can't
  /// belong to a number. Fails if `use` fails, and if a line is longer than `longest`.
  template <class Use>
  Result<void> feed(std::string_view piece, Use&& use) {
    while (!piece.empty()) {
      const auto end = piece.find('\n');
      const bool whole = end != std::string_view::npos;
      const std::string_view part = piece.substr(0, end);
      piece.remove_prefix(whole ? end + 1 : piece.size());
      // A binary file may have no line end at all. The limit keeps it from filling the memory.
      if (carry_.size() + part.size() > longest) return too_long();
      // A line that is complete within the piece is used in place, without a copy.
      if (whole && carry_.empty()) {
        KA_TRY(emit(part, use));
        continue;
      }
      carry_ += part;
      if (!whole) return {};
      // A std::string ends with '\0', so the character after this line is readable, too.
      KA_TRY(emit(carry_, use));
      carry_.clear();
    }
    return {};
  }

  /// Call this at the end of the text: a last line without a line end is a line, too.
  template <class Use>
  Result<void> finish(Use&& use) {
    if (carry_.empty()) return {};
    KA_TRY(emit(carry_, use));
    carry_.clear();
    return {};
  }

  std::int64_t number() const { return number_; }
  /// True if the text so far ends within a line, before the line end.
  bool within_line() const { return !carry_.empty(); }

 private:
  template <class Use>
  Result<void> emit(std::string_view line, Use&& use) {
    ++number_;
    if (line.ends_with('\r')) line.remove_suffix(1);
    return use(line);
  }

  Result<void> too_long() const {
    return Failure(Error{"", number_ + 1, "a line of at most " + std::to_string(longest) + " bytes",
                         "a longer line"});
  }

  // The beginning of a line whose end has not arrived; empty between lines.
  std::string carry_;
  // number_ is the number of lines completed so far.
  std::int64_t number_ = 0;
};

}  // namespace kinalign
