// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/nodes/answer_table.h"

namespace kinalign {

void AnswerTable::add(const GivenAnswer& answer) {
  GivenAnswer& place = answers_[answer.sequence % remembered];
  place = answer;
  place.given = true;
  if (!begun_ || static_cast<std::int32_t>(answer.sequence - newest_) > 0)
    newest_ = answer.sequence;
  begun_ = true;
}

AnswerTable::Found AnswerTable::find(std::uint32_t sequence, std::uint32_t nonce,
                                     GivenAnswer& answer) {
  if (!begun_) return Found::never;
  // The difference is signed, so it stays right when the numbers wrap.
  const auto back = static_cast<std::int32_t>(newest_ - sequence);
  if (back >= static_cast<std::int32_t>(remembered)) return Found::stale;
  GivenAnswer& place = answers_[sequence % remembered];
  if (!place.given || place.sequence != sequence || place.nonce != nonce) return Found::never;
  const bool used = place.used;
  // From now on the answer counts as named before. One exchange gives one bound, however often it
  // is echoed.
  place.used = true;
  answer = place;
  return used ? Found::before : Found::now;
}

}  // namespace kinalign
