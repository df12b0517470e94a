// SPDX-License-Identifier: Apache-2.0
// Decodes the broadcasts with which Vicon's programs start and stop each other:
// docs/formats/marks.md.
#pragma once

#include "kinalign/protocols/marks/mark.h"

namespace kinalign {

inline constexpr std::size_t most_vicon_trigger = 1500;

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

/// Encodes a broadcast as Vicon does, but without the zero at its end.
std::string encode_vicon_trigger(const ViconTrigger& trigger);

Mark mark_of(const ViconTrigger& trigger);

}  // namespace kinalign
