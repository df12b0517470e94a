// SPDX-License-Identifier: Apache-2.0
// Words of a BVH, with the line they stand on. Key words are told without regard to case.
#pragma once

#include "kinalign/core/error.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace kinalign {

/// As writers mean it: tabs, returns and other control characters too.
inline bool is_blank(char c) { return static_cast<unsigned char>(c) <= ' '; }

inline std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
  }
  return out;
}

/// Without such at both ends; a cell of a table loses less (cells.h).
inline std::string_view stripped(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

class BvhWords {
 public:
  BvhWords(std::string_view text, std::string_view name) : text_(text), name_(name) {}

  /// The next word; a brace is a word of its own. Empty at the end.
  std::string_view next() {
    skip_blanks();
    const std::size_t begin = at_;
    if (at_ < text_.size() && is_brace(text_[at_])) return text_.substr(at_++, 1);
    while (at_ < text_.size() && !is_blank(text_[at_]) && !is_brace(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  std::string_view peek() {
    const BvhWords before = *this;
    const std::string_view word = next();
    *this = before;
    return word;
  }

  /// What is left of the line, without a brace at its end: a name may hold blanks.
  std::string_view rest_of_line() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && text_[at_] != '\n' && text_[at_] != '{') ++at_;
    return stripped(text_.substr(begin, at_ - begin));
  }

  Error wrong(std::string expected, std::string_view found) const {
    return Error{std::string(name_), line_, std::move(expected),
                 found.empty() ? "the end of the file" : "'" + shown(found) + "'"};
  }

  std::int64_t line() const { return line_; }
  std::size_t at() const { return at_; }

 private:
  static bool is_brace(char c) { return c == '{' || c == '}'; }
  void skip_blanks() {
    for (; at_ < text_.size() && is_blank(text_[at_]); ++at_) line_ += text_[at_] == '\n' ? 1 : 0;
  }

  std::string_view text_, name_;
  std::size_t at_ = 0;
  std::int64_t line_ = 1;
};

}  // namespace kinalign
