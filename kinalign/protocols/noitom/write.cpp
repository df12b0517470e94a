// SPDX-License-Identifier: Apache-2.0
// Writes frames as Axis Studio does, for simulated suits.
#include "kinalign/protocols/noitom/frame.h"
#include "kinalign/wire/little_endian.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace kinalign {

std::span<const float> NoitomFrame::row() const {
  return std::span(values).subspan(reference ? std::min<std::size_t>(6, values.size()) : 0);
}

void append_noitom(const NoitomFrame& f, std::vector<std::uint8_t>& out) {
  assert(f.values.size() == noitom_values(f.displacement, f.reference));
  constexpr std::size_t name_field = 32;
  append_little(std::uint16_t{0xddff}, out);
  append_little(std::uint32_t{0x01010000}, out);  // the version, 1.1.0.0
  append_little(static_cast<std::uint16_t>(f.values.size()), out);
  append_little(std::uint8_t{f.displacement}, out);
  append_little(std::uint8_t{f.reference}, out);
  append_little(f.avatar, out);
  std::string name = f.name;
  name.resize(name_field);
  out.insert(out.end(), name.begin(), name.end());
  append_little(f.frame_index.value_or(0), out);
  append_little(std::uint32_t{0}, out);
  append_little(std::uint64_t{0}, out);
  append_little(std::uint16_t{0xeeff}, out);
  for (const float value : f.values) append_little(std::bit_cast<std::uint32_t>(value), out);
}

}  // namespace kinalign
