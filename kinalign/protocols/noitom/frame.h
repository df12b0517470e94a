// SPDX-License-Identifier: Apache-2.0
// One frame of the BVH broadcast of Noitom's Axis Neuron and Axis Studio, in the three forms that
// they send. Layout: docs/formats/noitom_stream.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kinalign {

/// The form of a frame. The header's version, or its count and flags, tell the two binary forms
/// apart.
enum class NoitomForm : std::uint8_t { old_header, new_header, text };

/// The values of one BVH row. Names, offsets and the order of rotations are not in the stream; they
/// come from a BVH file of the same program.
struct NoitomFrame {
  NoitomForm form = NoitomForm::new_header;
  std::uint32_t avatar = 0;  // counted from 0
  std::string name;          // name of the avatar, in the sender's encoding
  /// The source's frame number; only the new header has one.
  std::optional<std::uint32_t> frame_index;
  bool displacement = false;  // every joint has a position, not only the root
  bool reference = false;     // the first six values are a reference
  /// Centimetres and degrees as sent, including the reference; not checked.
  std::vector<float> values;

  /// The values of a BVH row, without the reference.
  std::span<const float> row() const;

  bool operator==(const NoitomFrame&) const = default;
};

/// Number of values in a frame: 180 or 354, and six more with a reference.
std::size_t noitom_values(bool displacement, bool reference);

/// Appends the frame's bytes with the new header, whatever its form. The values must fit the flags;
/// a name is cut to 32 bytes.
void append_noitom(const NoitomFrame& frame, std::vector<std::uint8_t>& out);

}  // namespace kinalign
