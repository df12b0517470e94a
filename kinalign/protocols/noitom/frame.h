// SPDX-License-Identifier: Apache-2.0
// One frame of the BVH broadcast of Noitom's Axis Neuron and Axis Studio, in the three forms they
// send it in. Layout: docs/formats/noitom_stream.md.
#pragma once

#include "kinalign/core/error.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kinalign {

enum class NoitomForm : std::uint8_t { old_header, new_header, text };

struct NoitomFrame {
  NoitomForm form = NoitomForm::new_header;
  std::uint32_t avatar = 0;                  // from 0
  std::string name;                          // of the avatar, in the sender's coding
  std::optional<std::uint32_t> frame_index;  // of the source; the new header alone has one
  bool displacement = false;                 // each joint has a position, not only the root
  bool reference = false;                    // six values of a reference stand in front
  std::vector<float> values;  // centimetres and degrees as sent, with the reference's; not judged

  /// The values of a BVH row: those behind the reference.
  std::span<const float> row() const;

  bool operator==(const NoitomFrame&) const = default;
};

/// Values in a frame: 180 or 354, and six more with a reference.
std::size_t noitom_values(bool displacement, bool reference);

/// Appends the frame's bytes. Fails where they would not be read as this frame: values that do not
/// fit the flags, a name too long (32 bytes) or, in text, one with blanks, an index that the form
/// has no place for.
Result<void> append_noitom(const NoitomFrame& frame, std::vector<std::uint8_t>& out);

}  // namespace kinalign
