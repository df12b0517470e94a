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

/// The size of a block in bytes. A file consists of blocks, numbered from 1.
constexpr std::size_t c3d_block = 512;

/// The machine whose number format the file uses. It determines the order of bytes and, for DEC,
/// also the format of floating-point numbers.
enum class C3dProcessor : std::uint8_t { intel = 84, dec = 85, mips = 86 };

/// Reads a number in the format of that machine. The caller must check that the bytes are present.
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
  std::string group, name;  // in upper case
  C3dType type = C3dType::text;
  std::vector<std::uint8_t> dimensions;  // lengths, the fastest-varying first; empty: one value
  /// [product of dimensions] values of `type` as in the file.
  std::vector<std::uint8_t> bytes;
};

/// All parameters of a file. The section itself states the processor, which determines how numbers
/// are read.
class C3dParameters {
 public:
  /// Parses a section, which begins with its own header of four bytes. `section_at` is the position
  /// of the section in the file. Fails if an entry extends beyond the section. The error contains
  /// `file` and the position in the file.
  static Result<C3dParameters> parse(std::span<const std::uint8_t> section, std::string_view file,
                                     std::uint64_t section_at);

  C3dProcessor processor() const { return processor_; }
  /// Finds a parameter by name, because the order of entries in a file is free.
  const C3dParameter* find(std::string_view group, std::string_view name) const;

  /// The value at `index`; empty if there is no such value. Integers are read as unsigned, because
  /// counts are stored as unsigned numbers.
  std::optional<double> number(std::string_view group, std::string_view name,
                               std::size_t index = 0) const;
  /// The texts of a parameter, without blanks and zeros at the end. Each text has the length of the
  /// first dimension.
  std::vector<std::string> texts(std::string_view group, std::string_view name) const;
  /// The texts of NAME, NAME2, NAME3 and so on, up to the first absent parameter.
  std::vector<std::string> all_texts(std::string_view group, std::string_view name) const;

 private:
  C3dProcessor processor_ = C3dProcessor::intel;
  std::vector<C3dParameter> parameters_;
};

}  // namespace kinalign
