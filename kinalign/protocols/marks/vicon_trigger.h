// SPDX-License-Identifier: Apache-2.0
// Decodes the broadcasts with which Vicon's programs start and stop each other:
// docs/formats/marks.md.
#pragma once

#include "kinalign/protocols/marks/mark.h"

namespace kinalign {

/// Bytes of a broadcast. Longer datagrams are refused unread.
inline constexpr std::size_t most_vicon_trigger = 1500;

/// The content of one broadcast. Texts are empty if their elements are absent. The path belongs to
/// the sender's machine; it is recorded and never opened.
struct ViconTrigger {
  bool start = false;  // false: a stop
  std::string name, notes, description, database_path, result;
  std::optional<Duration> delay;  // from the broadcast to the capture's start or stop
  std::optional<std::int64_t> packet_id;

  bool operator==(const ViconTrigger&) const = default;
};

enum class [[nodiscard]] ViconRefusal : std::uint8_t{none,         too_long,   bad_xml, not_capture,
                                                     wrong_number, wrong_text, twice};
inline constexpr std::size_t vicon_refusals = 7;

/// The refusal's name in --json: "bad_xml".
const char* name_of(ViconRefusal refusal);

/// The expected content, for a message: "a CaptureStart or CaptureStop".
const char* expected_of(ViconRefusal refusal);

/// Decodes a broadcast. After a refusal `trigger` is empty.
ViconRefusal decode_vicon_trigger(std::string_view datagram, ViconTrigger& trigger);

/// The mark of a broadcast. Several network cards send the same broadcast, so its packet id, kind
/// and name make the id by which repeats are recognised.
Mark mark_of(const ViconTrigger& trigger);

}  // namespace kinalign
