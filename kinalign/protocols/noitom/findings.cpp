// SPDX-License-Identifier: Apache-2.0
// Makes findings about a Noitom stream, with advice to the user.
#include "kinalign/protocols/noitom/stream.h"

#include <fmt/format.h>

namespace kinalign {

namespace {

// The texts for one kind of refusal. `repair` is empty if the user can't do anything.
struct Advice {
  NoitomRefusal refusal;
  std::string_view expected, meaning, repair;
};

constexpr std::string_view plain =
    "switch the capture program to plain BVH broadcast (binary or string, no compression)";
constexpr std::array<Advice, 8> advice{{
    {NoitomRefusal::compressed, "plain BVH frames", "compressed frames are not read", plain},
    {NoitomRefusal::calculation, "BVH frames", "this is the calculation stream (0x88FF)",
     "connect to the port of the BVH broadcast"},
    {NoitomRefusal::command, "BVH frames", "replies of the command channel are not read", ""},
    {NoitomRefusal::wrong_count, "180, 186, 354 or 360 values in a frame",
     "frames of other sizes were dropped", "broadcast the 59 joints of Axis Neuron or Axis Studio"},
    {NoitomRefusal::garbage, "frames of the BVH broadcast",
     "bytes that look like a frame but are not one were dropped",
     "check that only the BVH broadcast is sent to this port"},
    {NoitomRefusal::incomplete, "whole frames",
     "frames with a missing part, or with parts of two frames, were dropped",
     "use TCP: a UDP frame of more than 1,472 bytes is sent in several datagrams"},
    {NoitomRefusal::too_long, "text whose frames end in ||", "it was dropped", ""},
    {NoitomRefusal::too_many_avatars, "at most 64 avatars", "frames of further ones were dropped",
     ""},
}};

}  // namespace

std::string_view to_string(NoitomRefusal refusal) {
  constexpr std::array<std::string_view, 8> names{"wrong_count", "garbage",         "incomplete",
                                                  "compressed",  "calculation",     "command",
                                                  "too_long",    "too_many_avatars"};
  return names[static_cast<std::size_t>(refusal)];
}

Findings NoitomDecoder::findings(const std::string& name) const {
  Findings findings;
  for (const Advice& a : advice) {
    const std::uint64_t times = counts_[a.refusal];
    if (times == 0) continue;
    // On a wireless network, incomplete frames are ordinary losses and not a fault of the set-up.
    const bool is_loss = a.refusal == NoitomRefusal::incomplete;
    findings.push_back({is_loss ? Severity::note : Severity::warning,
                        Error{name, 0, std::string(a.expected),
                              fmt::format("{} ({})", to_string(a.refusal),
                                          times == 1 ? "once" : fmt::format("{} times", times))},
                        std::string(a.meaning), std::string(a.repair)});
  }
  return findings;
}

}  // namespace kinalign
