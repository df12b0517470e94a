// SPDX-License-Identifier: Apache-2.0
// Decodes the broadcasts by which Vicon's programs start and stop each other's captures.
// docs/formats/marks.md.
#pragma once

#include "kinalign/protocols/marks/mark.h"

namespace kinalign {

/// The most bytes of a broadcast. A longer datagram is refused without parsing.
inline constexpr std::size_t most_vicon_trigger = 1500;

/// The content of one broadcast. A text is empty if its element is absent. The path belongs to the
/// sender's machine: it is recorded, but never opened.
struct ViconTrigger {
  bool start = false;  // false: a stop
  std::string name, notes, description, database_path, result;
  std::optional<Duration> delay;  // time from the broadcast to the start or stop of the capture
  std::optional<std::int64_t> packet_id;

  bool operator==(const ViconTrigger&) const = default;
};

enum class [[nodiscard]] ViconRefusal : std::uint8_t{none,         too_long,   bad_xml, not_capture,
                                                     wrong_number, wrong_text, twice};
inline constexpr std::size_t vicon_refusals = 7;

/// The refusal's name in the output of --json, for example "bad_xml".
const char* name_of(ViconRefusal refusal);

/// The expected content, for a message: "a CaptureStart or CaptureStop".
const char* expected_of(ViconRefusal refusal);

/// Decodes a broadcast. If it is refused, `trigger` is empty.
ViconRefusal decode_vicon_trigger(std::string_view datagram, ViconTrigger& trigger);

/// The mark of a broadcast. A sender may send the same broadcast over several network cards. Packet
/// id, kind and name together form the mark's id, so that such repeats are recognised.
Mark mark_of(const ViconTrigger& trigger);

}  // namespace kinalign
