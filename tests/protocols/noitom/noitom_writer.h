// SPDX-License-Identifier: Apache-2.0
// Writes frames in each form of Axis Neuron and Axis Studio, for tests and the fuzzer.
#pragma once

#include "kinalign/protocols/noitom/frame.h"
#include "kinalign/wire/little_endian.h"

#include <array>
#include <bit>
#include <charconv>
#include <string>

namespace kinalign {

inline void append_old_noitom(const NoitomFrame& f, std::vector<std::uint8_t>& out) {
  append_little(std::uint16_t{0xddff}, out);
  append_little(std::uint32_t{0x01000002}, out);  // 1.0.0.2
  append_little(static_cast<std::uint32_t>(f.values.size()), out);
  append_little(std::uint32_t{f.displacement}, out);
  append_little(std::uint32_t{f.reference}, out);
  append_little(f.avatar, out);
  std::string name = f.name;
  name.resize(32);
  out.insert(out.end(), name.begin(), name.end());
  append_little(std::uint64_t{0}, out);
  append_little(std::uint16_t{0xeeff}, out);
  for (const float value : f.values) append_little(std::bit_cast<std::uint32_t>(value), out);
}

inline void append_text_noitom(const NoitomFrame& f, std::vector<std::uint8_t>& out) {
  std::string text = std::to_string(f.avatar) + ' ' + f.name;
  for (const float value : f.values) {
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    text += ' ';
    text.append(digits.data(), end);
  }
  text += " ||";
  out.insert(out.end(), text.begin(), text.end());
}

/// Appends the frame's bytes in its form.
inline void append_form_of_noitom(const NoitomFrame& f, std::vector<std::uint8_t>& out) {
  switch (f.form) {
    case NoitomForm::old_header:
      return append_old_noitom(f, out);
    case NoitomForm::new_header:
      return append_noitom(f, out);
    case NoitomForm::text:
      return append_text_noitom(f, out);
  }
}

}  // namespace kinalign
