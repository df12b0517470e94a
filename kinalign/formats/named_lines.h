// SPDX-License-Identifier: Apache-2.0
// Splits a text file into lines. Adds the file's name and the line number to errors.
#pragma once

#include "kinalign/core/error.h"
#include "kinalign/core/lines.h"
#include "kinalign/core/utf8.h"

#include <string>
#include <string_view>
#include <utility>

namespace kinalign {

/// The finding for a last line without a line end that could be read nevertheless.
inline Finding unended_finding(const std::string& file, std::int64_t line) {
  return {Severity::note,
          Error{file, line, "a line end after the last value", "the end of the file"},
          "the file was probably truncated, and the last value may be incomplete", ""};
}

class NamedLines {
 public:
  explicit NamedLines(std::string_view file) : file_(file) {}

  /// Calls `use(line)`, which returns Result<void>, for each completed line. Adds this file and
  /// line to an error without a file. A byte order mark at the beginning of the file is dropped.
  template <class Use>
  Result<void> feed(std::string_view piece, Use&& use) {
    return placed(lines_.feed(piece, [&](std::string_view line) { return use(unmarked(line)); }));
  }

  /// Call this at the end of the file. A last line without a line end may be incomplete. If that
  /// line can't be used, a warning is added to `incomplete`, and the call succeeds. If it can be
  /// used, a note says that its last value may be incomplete.
  template <class Use>
  Result<void> finish(Use&& use, Findings& incomplete) {
    auto last = finish_head(std::forward<Use>(use), incomplete);
    if (!last) {
      add_warning(incomplete, std::move(last).error(),
                  "the last line is incomplete and was dropped");
    }
    return {};
  }

  /// Like finish(), but for a file that ends within its header. An incomplete last line is then an
  /// error, because the file can't be read without its header.
  template <class Use>
  Result<void> finish_head(Use&& use, Findings& incomplete) {
    // This is tested before finish(), which uses the last line.
    const bool unended = lines_.within_line();
    KA_TRY(placed(lines_.finish([&](std::string_view line) { return use(unmarked(line)); })));
    if (unended) incomplete.push_back(unended_finding(file_, lines_.number()));
    return {};
  }

  /// An error at the last line.
  Error error(std::string expected, std::string found) const {
    if (found.empty()) found = "nothing";
    return {file_, lines_.number(), std::move(expected), std::move(found)};
  }

  const std::string& file() const { return file_; }
  std::int64_t number() const { return lines_.number(); }

 private:
  std::string_view unmarked(std::string_view line) const {
    return lines_.number() == 1 ? without_byte_order_mark(line) : line;
  }

  Result<void> placed(Result<void> result) const {
    if (!result && result.error().file.empty()) {
      result.error().file = file_;
      if (result.error().line == 0) result.error().line = lines_.number();
    }
    return result;
  }

  std::string file_;
  LineSplitter lines_;
};

}  // namespace kinalign
