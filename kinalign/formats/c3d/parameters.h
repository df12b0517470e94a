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

/// A file consists of blocks of so many bytes; block numbers start at 1.
constexpr std::size_t c3d_block = 512;

/// The kind of machine in whose number format the file is written.
/// The machine decides on the order of bytes, and for DEC also on the format of numbers.
enum class C3dProcessor : std::uint8_t { intel = 84, dec = 85, mips = 86 };

/// Reads a number in that machine's format; the caller makes sure that its bytes are present.
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
  std::vector<std::uint8_t> dimensions;  // lengths, the fastest-varying first; none: a single value
  /// [product of dimensions] values of `type` as in the file
  std::vector<std::uint8_t> bytes;
};

/// The processor is stated in the section itself; it decides how numbers are read.
class C3dParameters {
 public:
  /// Parses a section, which begins with its own four header bytes. `section_at` is the section's
  /// offset in the file. Fails, with `file` and the offset in the file, if an entry reaches beyond
  /// the section.
  static Result<C3dParameters> parse(std::span<const std::uint8_t> section, std::string_view file,
                                     std::uint64_t section_at);

  C3dProcessor processor() const { return processor_; }
  /// The order of entries in a file is free, so groups and parameters are looked up by name.
  const C3dParameter* find(std::string_view group, std::string_view name) const;

  /// The value at `index`. Integers are read as unsigned, because counts are stored so. Empty if
  /// there is no such value.
  std::optional<double> number(std::string_view group, std::string_view name,
                               std::size_t index = 0) const;
  /// The texts of a parameter, each as long as its first dimension, without blanks and zeros at the
  /// end.
  std::vector<std::string> texts(std::string_view group, std::string_view name) const;
  /// The texts of NAME, NAME2, NAME3, ..., up to the first that is absent.
  std::vector<std::string> all_texts(std::string_view group, std::string_view name) const;

 private:
  C3dProcessor processor_ = C3dProcessor::intel;
  std::vector<C3dParameter> parameters_;
};

}  // namespace kinalign
