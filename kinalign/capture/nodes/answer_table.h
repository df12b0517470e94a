// SPDX-License-Identifier: Apache-2.0
// The last 256 answers sent to one node. An echo or a confirm counts only if it names one of these
// answers and its nonce. The times are taken from this table, not from the copies that the node
// sends.
#pragma once

#include "kinalign/wire/time.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace kinalign {

struct GivenAnswer {
  // the reply's number; for an answer to a node without a clock, the request's number
  std::uint32_t sequence = 0;
  std::uint32_t nonce = 0;
  HostTime t2{}, t3{};      // arrival of the answered datagram, departure of the answer
  std::uint64_t frame = 0;  // the widened number of the answered datagram
  // `given`: the entry is in use. `used`: the node has named the answer.
  bool given = false, used = false;
};

/// A ring: an answer takes the place of the one 256 numbers before it.
class AnswerTable {
 public:
  static constexpr std::size_t remembered = 256;

  enum class Found : std::uint8_t {
    now,     // the answer is named for the first time
    before,  // the answer was named before
    stale,   // too old: the answer is no longer in the table
    never    // the answer was not sent, or it has another nonce
  };

  void add(const GivenAnswer& answer);
  /// Looks an answer up. `answer` is set if the answer is known.
  Found find(std::uint32_t sequence, std::uint32_t nonce, GivenAnswer& answer);

 private:
  // Indexed by sequence modulo `remembered`. Stored outside the object, so that a search through
  // all sessions stays in the cache.
  std::vector<GivenAnswer> answers_ = std::vector<GivenAnswer>(remembered);
  std::uint32_t newest_ = 0;
  bool begun_ = false;
};

}  // namespace kinalign
