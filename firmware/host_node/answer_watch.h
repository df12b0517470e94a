// SPDX-License-Identifier: Apache-2.0
// The messages of host_node while no host answers it: seldom, but from the first seconds on. A
// refused node goes on sending, and without a message it would look like one that is accepted.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

namespace kinalign {

class AnswerWatch {
 public:
  /// `server`: the text that the user gave; `keyed`: the node has a key.
  AnswerWatch(std::string server, bool keyed) : server_(std::move(server)), keyed_(keyed) {}

  /// To be called some times a second with the answers so far: `accepted` ones, and those with a
  /// wrong key. Gives a line to print now, or "".
  std::string look(std::int64_t age_ns, std::uint64_t accepted, std::uint64_t wrong_key);

 private:
  std::string complaint(std::int64_t silent_ns, bool answers_came) const;

  std::string server_;
  bool keyed_;
  bool complained_ = false;
  std::uint64_t accepted_ = 0, wrong_key_ = 0;  // the counts at the last answer
  std::int64_t answered_ns_ = 0;
  std::int64_t next_ns_ = first_ns;

  static constexpr std::int64_t first_ns = 5'000'000'000, every_ns = 60'000'000'000;
};

}  // namespace kinalign
