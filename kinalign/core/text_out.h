// SPDX-License-Identifier: Apache-2.0
// Writes text with many numbers into a file, in blocks of about a megabyte.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/core/numbers.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

namespace kinalign {

class TextOut {
 public:
  static Result<TextOut> create(FileSystem& files, std::string path, Overwrite overwrite) {
    // The buffer has room for two blocks. The first end of a line after one full block flushes it.
    return TextOut(KA_TRY(OutputFile::create(files, std::move(path), overwrite)));
  }
  explicit TextOut(OutputFile file) : file_(std::move(file)) { held_.reserve(2 * most_held); }

  void text(std::string_view piece) { held_ += piece; }

  /// Writes `before` (unless it is '\0') and then `value`, rounded to `decimals` (0 to 9) decimals.
  void number(char before, double value, int decimals) {
    constexpr std::array<double, 10> scales{1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9};
    const double scale = scales[static_cast<std::size_t>(decimals)];
    std::array<char, number_room> room{};
    // The value is rounded here, because put_number() writes every digit that a double has. Adding
    // 0.0 turns -0.0 into 0.0, so "-0.0000" is never written.
    const double rounded = std::nearbyint(value * scale) / scale + 0.0;
    const char* end = put_number(room.data(), rounded, decimals);
    if (before != '\0') held_ += before;
    held_.append(room.data(), static_cast<std::size_t>(end - room.data()));
  }

  void integer(std::int64_t value) {
    std::array<char, 24> room{};
    const char* end = std::to_chars(room.data(), room.data() + room.size(), value).ptr;
    held_.append(room.data(), static_cast<std::size_t>(end - room.data()));
  }

  /// Ends a line. If the buffer is full, its content is written to the file.
  Result<void> end_line() {
    held_ += '\n';
    return held_.size() < most_held ? Result<void>{} : flush();
  }

  Result<void> commit() {
    KA_TRY(flush());
    return file_.commit();
  }

 private:
  static constexpr std::size_t most_held = std::size_t{1} << 20;

  Result<void> flush() {
    KA_TRY(file_.write(held_));
    held_.clear();
    return {};
  }

  // The file does not contain the text in held_ yet, and has no name before commit().
  OutputFile file_;
  std::string held_;
};

}  // namespace kinalign
