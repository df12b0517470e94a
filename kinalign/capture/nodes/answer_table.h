// SPDX-License-Identifier: Apache-2.0
// The last 256 answers sent to one node. A frame of a node names an answer in its echo; a node
// without a clock names an answer in a confirm. An echo or a confirm is valid only if it names one
// of these answers and its nonce. The times come from this table, not from the copies that the node
// sends.
#pragma once

#include "kinalign/capture/nodes/node_verdict.h"
#include "kinalign/wire/counter.h"
#include "kinalign/wire/time.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace kinalign {

struct GivenAnswer {
  // the reply's number; for an answer to a node without a clock, the request's number
  std::uint32_t sequence = 0;
  std::uint32_t nonce = 0;
  HostTime t2{}, t3{};      // arrival of the answered datagram, departure of the answer
  std::uint64_t frame = 0;  // the unwrapped number of the answered datagram
  // `given`: the entry is in use. `used`: the node has already named this answer.
  bool given = false, used = false;
};

/// A ring buffer: an answer replaces the answer whose number is lower by 256.
class AnswerTable {
 public:
  static constexpr std::size_t remembered = 256;

  void add(const GivenAnswer& answer) {
    GivenAnswer& place = answers_[answer.sequence % remembered];
    place = answer;
    place.given = true;
  }
  /// Looks up the answer that an echo or a confirm names. `answer` is set if the verdict is taken
  /// or repeated.
  EchoVerdict find(std::uint32_t sequence, std::uint32_t nonce, GivenAnswer& answer) {
    GivenAnswer& place = answers_[sequence % remembered];
    if (!place.given) return EchoVerdict::unknown;
    // A later answer has replaced this answer.
    if (steps_between(sequence, place.sequence, 32) > 0) return EchoVerdict::stale;
    if (place.sequence != sequence || place.nonce != nonce) return EchoVerdict::unknown;
    answer = place;
    // One exchange gives one clock bound, even if the node echoes the answer several times.
    return std::exchange(place.used, true) ? EchoVerdict::repeated : EchoVerdict::taken;
  }

 private:
  // Indexed by sequence modulo `remembered`. The vector keeps this object small, so that a search
  // through all sessions stays in the processor's cache.
  std::vector<GivenAnswer> answers_ = std::vector<GivenAnswer>(remembered);
};

}  // namespace kinalign
