// SPDX-License-Identifier: Apache-2.0
// Writes frames in the forms of Axis Neuron and Axis Studio.
#include "kinalign/protocols/noitom/header.h"
#include "kinalign/wire/little_endian.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>

namespace kinalign {

namespace {

constexpr std::size_t name_field = 32;

void append_name(const std::string& name, std::vector<std::uint8_t>& out) {
  out.insert(out.end(), name.begin(), name.end());
  out.insert(out.end(), name_field - name.size(), 0);
}

void append_old_header(const NoitomFrame& f, std::vector<std::uint8_t>& out) {
  append_little(std::uint32_t{0x01000002}, out);  // 1.0.0.2
  append_little(static_cast<std::uint32_t>(f.values.size()), out);
  append_little(std::uint32_t{f.displacement}, out);
  append_little(std::uint32_t{f.reference}, out);
  append_little(f.avatar, out);
  append_name(f.name, out);
  append_little(std::uint64_t{0}, out);
}

void append_new_header(const NoitomFrame& f, std::vector<std::uint8_t>& out) {
  append_little(std::uint32_t{0x01010000}, out);  // 1.1.0.0
  append_little(static_cast<std::uint16_t>(f.values.size()), out);
  append_little(std::uint8_t{f.displacement}, out);
  append_little(std::uint8_t{f.reference}, out);
  append_little(f.avatar, out);
  append_name(f.name, out);
  append_little(f.frame_index.value_or(0), out);
  append_little(std::uint32_t{0}, out);
  append_little(std::uint64_t{0}, out);
}

void append_text(const NoitomFrame& f, std::vector<std::uint8_t>& out) {
  std::string text = fmt::format("{} {}", f.avatar, f.name);
  for (const float value : f.values) {
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    text += ' ';
    text.append(digits.data(), end);
  }
  text += " ||";
  out.insert(out.end(), text.begin(), text.end());
}

// A name with a blank would be read as two words, and `|` could be read as the frame's end. 0x7F
// and 0xFF end a text for the decoder.
bool can_stand_in_text(const NoitomFrame& f) {
  const auto fits = [](char c) {
    return static_cast<unsigned char>(c) > ' ' && c != '|' && c != '\x7f' && c != '\xff';
  };
  const auto finite = [](float x) { return x - x == 0.0F; };
  return !f.name.empty() && std::all_of(f.name.begin(), f.name.end(), fits) &&
         std::all_of(f.values.begin(), f.values.end(), finite);
}

Failure refused(const std::string& expected, const std::string& found) {
  return Failure(Error{"", 0, expected, found});
}

// Refuses a frame that the decoder would not read back as the same frame.
Result<void> judge(const NoitomFrame& f) {
  const std::size_t values = noitom_values(f.displacement, f.reference);
  if (f.values.size() != values) {
    return refused(fmt::format("{} values", values), std::to_string(f.values.size()));
  }
  if (f.name.size() > name_field || f.name.find('\0') != std::string::npos) {
    return refused("an avatar's name of at most 32 bytes", "'" + shown(f.name) + "'");
  }
  if (f.frame_index && f.form != NoitomForm::new_header) {
    return refused("no frame index: only the new header has room for it",
                   std::to_string(*f.frame_index));
  }
  if (f.form == NoitomForm::text && !can_stand_in_text(f)) {
    return refused("a name without blanks and finite values, as text wants them",
                   "'" + shown(f.name) + "'");
  }
  return {};
}

}  // namespace

std::span<const float> NoitomFrame::row() const {
  return std::span(values).subspan(reference ? std::min<std::size_t>(6, values.size()) : 0);
}

Result<void> append_noitom(const NoitomFrame& frame, std::vector<std::uint8_t>& out) {
  KA_TRY(judge(frame));
  if (frame.form == NoitomForm::text) {
    append_text(frame, out);
    return {};
  }
  append_little(std::uint16_t{0xddff}, out);
  frame.form == NoitomForm::new_header ? append_new_header(frame, out)
                                       : append_old_header(frame, out);
  append_little(std::uint16_t{0xeeff}, out);
  for (const float value : frame.values) append_little(std::bit_cast<std::uint32_t>(value), out);
  return {};
}

}  // namespace kinalign
