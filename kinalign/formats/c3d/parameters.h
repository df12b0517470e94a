// SPDX-License-Identifier: Apache-2.0
// The parameters of a C3D file: named arrays in named groups. Layout: docs/formats/c3d.md.
#pragma once

#include "kinalign/core/error.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kinalign {

/// A file consists of blocks of this many bytes, counted from 1.
constexpr std::size_t c3d_block = 512;

/// The machine whose numbers a file has.
enum class C3dProcessor : std::uint8_t { intel = 84, dec = 85, mips = 86 };

/// Numbers of that machine; their bytes must be there.
inline std::uint16_t c3d_u16(C3dProcessor processor, const std::uint8_t* at) {
  return processor == C3dProcessor::mips ? static_cast<std::uint16_t>(at[0] << 8 | at[1])
                                         : static_cast<std::uint16_t>(at[1] << 8 | at[0]);
}
inline std::int16_t c3d_i16(C3dProcessor processor, const std::uint8_t* at) {
  return static_cast<std::int16_t>(c3d_u16(processor, at));
}
double c3d_f32(C3dProcessor processor, const std::uint8_t* at);

/// The types of a parameter's values.
enum class C3dType : std::int8_t { text = -1, byte = 1, i16 = 2, f32 = 4 };

struct C3dParameter {
  std::string group, name;  // in capitals
  C3dType type = C3dType::text;
  std::vector<std::uint8_t> dimensions;  // the first one is the fastest; none: one value
  std::vector<std::uint8_t> bytes;
};

class C3dParameters {
 public:
  /// `section` begins with its own four bytes. Fails, with `file` and the offset in the file, where
  /// an entry reaches beyond the section; `section_at` is the section's own offset.
  static Result<C3dParameters> parse(std::span<const std::uint8_t> section, std::string_view file,
                                     std::uint64_t section_at);

  C3dProcessor processor() const { return processor_; }
  const C3dParameter* find(std::string_view group, std::string_view name) const;

  /// The value at `index`; integers without a sign, as counts are stored. Empty where there is
  /// none.
  std::optional<double> number(std::string_view group, std::string_view name,
                               std::size_t index = 0) const;
  /// Texts of the first dimension's length, without blanks and zeros at their ends.
  std::vector<std::string> texts(std::string_view group, std::string_view name) const;
  /// The same of NAME, NAME2, NAME3, ..., as far as they go on.
  std::vector<std::string> all_texts(std::string_view group, std::string_view name) const;

 private:
  C3dProcessor processor_ = C3dProcessor::intel;
  std::vector<C3dParameter> parameters_;
};

}  // namespace kinalign
