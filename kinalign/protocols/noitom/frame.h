// SPDX-License-Identifier: Apache-2.0
// One frame of the BVH broadcast that Noitom's Axis Neuron and Axis Studio send. Three forms of a
// frame exist: docs/formats/noitom_stream.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kinalign {

/// The form of a frame. In a binary frame, the header's version distinguishes the old from the new
/// form. If the version is unknown, the header's count and flags do.
enum class NoitomForm : std::uint8_t { old_header, new_header, text };

/// The values of one row of a BVH file. The stream does not contain joint names, offsets and the
/// order of rotations. They come from a BVH file of the same program.
struct NoitomFrame {
  NoitomForm form = NoitomForm::new_header;
  std::uint32_t avatar = 0;  // from 0
  std::string name;          // the avatar's name, in the sender's encoding
  /// The source's frame number. Only the new header contains one.
  std::optional<std::uint32_t> frame_index;
  bool displacement = false;  // every joint has a position, not only the root
  bool reference = false;     // the first six values are a reference point and rotation
  /// Values as sent, centimetres and degrees, including the reference. They are not checked.
  std::vector<float> values;

  /// The values of a BVH row, which do not include the reference.
  std::span<const float> row() const;

  bool operator==(const NoitomFrame&) const = default;
};

/// The number of values in a frame: 180 without and 354 with displacement, and six more with a
/// reference.
std::size_t noitom_values(bool displacement, bool reference);

/// Appends the frame's bytes with the new header, whatever its form. The number of values must fit
/// the flags. A name is cut to 32 bytes.
void append_noitom(const NoitomFrame& frame, std::vector<std::uint8_t>& out);

}  // namespace kinalign
