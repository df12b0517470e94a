// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/noitom/header.h"

#include "kinalign/wire/little_endian.h"

#include <algorithm>

namespace kinalign {

namespace {

// Positions within the header: docs/formats/noitom_stream.md, "Binary".
constexpr std::size_t old_flags_end = 18, new_flags_end = 10;
constexpr std::size_t minor_at = 4, major_at = 5;

// The number of values and the flags of a header. The flags determine the number of values, so the
// header is redundant. `fits` uses this redundancy to distinguish the two layouts, and headers from
// random bytes.
struct Shape {
  std::uint64_t count = 0, displacement = 0, reference = 0;

  bool fits() const {
    return displacement <= 1 && reference <= 1 &&
           count == noitom_values(displacement == 1, reference == 1);
  }
};

Shape old_shape(std::span<const std::uint8_t> b) {
  return {little_at<std::uint32_t>(b, 6), little_at<std::uint32_t>(b, 10),
          little_at<std::uint32_t>(b, 14)};
}

Shape new_shape(std::span<const std::uint8_t> b) {
  return {little_at<std::uint16_t>(b, 6), b[8], b[9]};
}

/// The layout of a header. Version 1.0 is the old layout, and versions 1.1, 1.2 and so on are the
/// new layout. For any other version, the result is the layout whose count and flags fit.
std::optional<NoitomForm> form_of(std::span<const std::uint8_t> b) {
  const unsigned minor = b[minor_at], major = b[major_at];
  const bool may_be_new = major != 1 || minor >= 1, may_be_old = major != 1 || minor == 0;
  if (may_be_new && new_shape(b).fits()) return NoitomForm::new_header;
  if (may_be_old && b.size() >= old_flags_end && old_shape(b).fits()) return NoitomForm::old_header;
  return std::nullopt;
}

// The field of the name is padded with zeros. A name of 32 bytes has no zero at its end.
std::string name_of(std::span<const std::uint8_t> field) {
  const auto end = std::find(field.begin(), field.end(), std::uint8_t{0});
  return {field.begin(), end};
}

}  // namespace

std::size_t noitom_values(bool displacement, bool reference) {
  return (displacement ? 354U : 180U) + (reference ? 6U : 0U);
}

bool has_noitom_tokens(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 2 || bytes[0] != 0xff || bytes[1] != 0xdd) return false;
  return bytes.size() < noitom_header_size || (bytes[62] == 0xff && bytes[63] == 0xee);
}

std::optional<NoitomHeader> parse_noitom_header(std::span<const std::uint8_t> bytes) {
  const auto form = form_of(bytes);
  if (!form) return std::nullopt;
  const bool is_new = *form == NoitomForm::new_header;
  const Shape shape = is_new ? new_shape(bytes) : old_shape(bytes);
  NoitomHeader header;
  header.frame.form = *form;
  header.frame.displacement = shape.displacement == 1;
  header.frame.reference = shape.reference == 1;
  header.frame.avatar = little_at<std::uint32_t>(bytes, is_new ? 10 : 18);
  header.frame.name = name_of(bytes.subspan(is_new ? 14 : 22, 32));
  header.values = shape.count;
  if (is_new) header.frame.frame_index = little_at<std::uint32_t>(bytes, 46);
  header.compressed = !is_new && little_at<std::uint16_t>(bytes, 54) != 0;
  return header;
}

bool begins_noitom_header(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= new_flags_end && has_noitom_tokens(bytes) && form_of(bytes).has_value();
}

std::size_t stated_noitom_values(std::span<const std::uint8_t> bytes) {
  const bool is_old = bytes[major_at] == 1 && bytes[minor_at] == 0;
  return is_old ? old_shape(bytes).count : new_shape(bytes).count;
}

}  // namespace kinalign
