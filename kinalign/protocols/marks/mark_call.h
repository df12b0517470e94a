// SPDX-License-Identifier: Apache-2.0
// Our own call for marks, a datagram with a JSON object: docs/formats/marks.md.
#pragma once

#include "kinalign/protocols/marks/mark.h"

#include <span>

namespace kinalign {

inline constexpr std::size_t most_mark_call = 1200;

enum class [[nodiscard]] MarkCallRefusal : std::uint8_t{
    none, too_long, bad_json, wrong_schema, wrong_kind, wrong_id, wrong_latency, wrong_text};
inline constexpr std::size_t mark_call_refusals = 8;

/// As in --json: "wrong_id".
const char* name_of(MarkCallRefusal refusal);

/// What was expected instead, for who is told: "an id, 1 to 64 printable ASCII characters".
const char* expected_of(MarkCallRefusal refusal);

/// After a refusal `mark` is as new, but for the id of a call that has one.
MarkCallRefusal decode_mark_call(std::string_view datagram, Mark& mark);

/// As it is sent.
std::string encode_mark_call(const Mark& mark);

enum class MarkAnswer : std::uint8_t { fresh, repeat };
/// What is answered to a call of `call_size` bytes; empty where it would be longer than that.
std::string answer_to_mark_call(const Mark& mark, MarkAnswer answer, std::size_t call_size);
/// The same for a call that is refused; `mark` as decode_mark_call left it. Empty, too, where what
/// came does not say that it is such a call: two programs that each answer what they don't
/// understand would never end.
std::string answer_to_refused_call(const Mark& mark, MarkCallRefusal refusal,
                                   std::size_t call_size);

}  // namespace kinalign
