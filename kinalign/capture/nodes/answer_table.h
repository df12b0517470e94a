// SPDX-License-Identifier: Apache-2.0
// What was answered to one node, the last 256: an echo or a confirm counts where it names one of
// them with its nonce, and the times are those that stand here, whatever the node copies.
#pragma once

#include "kinalign/wire/time.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace kinalign {

struct GivenAnswer {
  std::uint32_t sequence = 0;  // of the reply; of an answer to a clockless node: of its request
  std::uint32_t nonce = 0;
  HostTime t2{}, t3{};      // arrival of what was answered, departure of the answer
  std::uint64_t frame = 0;  // the widened number of what was answered
  bool given = false, used = false;
};

class AnswerTable {
 public:
  static constexpr std::size_t remembered = 256;

  enum class Found : std::uint8_t {
    now,     // named for the first time
    before,  // named again
    stale,   // given, and forgotten since
    never    // not given, or with another nonce
  };

  void add(const GivenAnswer& answer);
  /// `answer` is set where it is known.
  Found find(std::uint32_t sequence, std::uint32_t nonce, GivenAnswer& answer);

 private:
  // By sequence modulo their number. Not in place: who looks through lives should not pass it.
  std::vector<GivenAnswer> answers_ = std::vector<GivenAnswer>(remembered);
  std::uint32_t newest_ = 0;
  bool begun_ = false;
};

}  // namespace kinalign
