// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/noitom/text.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace kinalign {

namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t start = at;
    while (at < text.size() && !is_space(text[at])) ++at;
    if (at > start) words.push_back(text.substr(start, at - start));
    while (at < text.size() && is_space(text[at])) ++at;
  }
  return words;
}

// Reads a whole word as a number, with an optional plus sign. Infinity and NaN are refused; unlike
// for all other numbers, their difference from themselves is not 0.
template <class Number>
bool read(std::string_view word, Number& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const char* const end = word.data() + word.size();
  const auto [behind, fault] = std::from_chars(word.data(), end, value);
  return fault == std::errc{} && behind == end && value - value == Number{0};
}

/// The frame that consists of exactly these words; empty if a word has the wrong form.
std::optional<NoitomFrame> frame_of(std::span<const std::string_view> words) {
  NoitomFrame frame;
  frame.form = NoitomForm::text;
  float number = 0.0F;
  if (!read(words[0], frame.avatar)) return std::nullopt;
  if (words[1].find('|') != std::string_view::npos) return std::nullopt;
  frame.name = words[1].substr(0, 32);  // cut to the length of a binary header's field
  for (const std::string_view word : words.subspan(2)) {
    if (!read(word, number)) return std::nullopt;
    frame.values.push_back(number);
  }
  return frame;
}

}  // namespace

// The number of values shows whether displacement and reference are included. The frame stands at
// the end of the text. Words in front of it belong to a frame whose end was lost.
std::optional<NoitomFrame> parse_noitom_text(std::string_view text) {
  const auto words = words_of(text);
  for (const bool displacement : {true, false}) {
    for (const bool reference : {true, false}) {
      const std::size_t size = 2 + noitom_values(displacement, reference);
      if (words.size() < size) continue;
      const auto last = std::span(words).last(size);
      float number = 0.0F;
      // If other words come first, a number in the place of the name is a value of such a frame.
      if (words.size() > size && read(last[1], number)) continue;
      auto frame = frame_of(last);
      if (!frame) continue;
      frame->displacement = displacement;
      frame->reference = reference;
      return frame;
    }
  }
  return std::nullopt;
}

// Counts the numbers at the end of the text. In a frame, the name of the avatar stands before the
// numbers, and the avatar's index before the name.
NoitomNoFrame judge_noitom_text(std::string_view text) {
  const auto words = words_of(text);
  float number = 0.0F;
  const auto name = std::find_if(words.rbegin(), words.rend(),
                                 [&](std::string_view word) { return !read(word, number); });
  if (name == words.rend()) return NoitomNoFrame::numbers;
  const auto values = static_cast<std::size_t>(name - words.rbegin());
  // Each position and each rotation has three values.
  if (values == 0 || values % 3 != 0 || values + 2 > words.size()) return NoitomNoFrame::other;
  const bool begins = frame_of(std::span(words).last(values + 2)).has_value();
  return begins ? NoitomNoFrame::other_count : NoitomNoFrame::other;
}

}  // namespace kinalign
