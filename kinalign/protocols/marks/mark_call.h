// SPDX-License-Identifier: Apache-2.0
// kinalign's own protocol for marks: a call is a datagram with a JSON object.
// docs/formats/marks.md.
#pragma once

#include "kinalign/protocols/marks/mark.h"

#include <span>

namespace kinalign {

/// The most bytes of a call. A longer datagram is refused without parsing.
inline constexpr std::size_t most_mark_call = 1200;

/// Reasons to refuse a call. The order matters: from `wrong_kind` on, the datagram has kinalign's
/// schema, and the caller gets an answer.
enum class [[nodiscard]] MarkCallRefusal : std::uint8_t{
    none, too_long, bad_json, wrong_schema, wrong_kind, wrong_id, wrong_latency, wrong_text};
/// The number of values of the enum, for arrays of counts.
inline constexpr std::size_t mark_call_refusals = 8;

/// The refusal's name in the output of --json, for example "wrong_id".
const char* name_of(MarkCallRefusal refusal);

/// The expected content, for the answer to the caller: "an id, 1 to 64 printable ASCII characters".
const char* expected_of(MarkCallRefusal refusal);

/// Decodes a call. If it is refused, `mark` is empty, except for the id if the call has an id.
MarkCallRefusal decode_mark_call(std::string_view datagram, Mark& mark);

/// Encodes a call as a JSON text.
std::string encode_mark_call(const Mark& mark);

/// Tells whether a call is new or repeated. Callers send a call two or three times, because a
/// datagram may be lost. A repeated call is answered, too, but makes no second mark.
enum class MarkAnswer : std::uint8_t { fresh, repeat };
/// The answer to a call of `call_size` bytes. It is empty if it would be longer than the call.
std::string answer_to_mark_call(const Mark& mark, MarkAnswer answer, std::size_t call_size);
/// The answer to a refused call. `mark` comes from decode_mark_call(). The answer is empty if it
/// would be longer than the call. It is also empty if the datagram does not have kinalign's schema:
/// otherwise two programs could answer each other without end.
std::string answer_to_refused_call(const Mark& mark, MarkCallRefusal refusal,
                                   std::size_t call_size);

}  // namespace kinalign
