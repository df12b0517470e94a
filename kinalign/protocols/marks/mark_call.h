// SPDX-License-Identifier: Apache-2.0
// Our own protocol for marks: a datagram with a JSON object. docs/formats/marks.md.
#pragma once

#include "kinalign/protocols/marks/mark.h"

#include <span>

namespace kinalign {

/// Bytes of a call. Longer datagrams are refused unread.
inline constexpr std::size_t most_mark_call = 1200;

/// Reasons to refuse a call. The order matters: from `wrong_kind` on, the datagram has our schema
/// and its sender gets an answer.
enum class [[nodiscard]] MarkCallRefusal : std::uint8_t{
    none, too_long, bad_json, wrong_schema, wrong_kind, wrong_id, wrong_latency, wrong_text};
/// Number of values of the enum, for arrays of counts.
inline constexpr std::size_t mark_call_refusals = 8;

/// The refusal's name in --json: "wrong_id".
const char* name_of(MarkCallRefusal refusal);

/// The expected content, for the message to the caller: "an id, 1 to 64 printable ASCII
/// characters".
const char* expected_of(MarkCallRefusal refusal);

/// Decodes a call. After a refusal `mark` is empty, except for the id if the call has one.
MarkCallRefusal decode_mark_call(std::string_view datagram, Mark& mark);

/// Encodes a call.
std::string encode_mark_call(const Mark& mark);

/// Callers send a call two or three times, because a datagram may be lost. A repeat is answered
/// too, but makes no second mark.
enum class MarkAnswer : std::uint8_t { fresh, repeat };
/// The answer to a call of `call_size` bytes; empty if it would be longer than the call.
std::string answer_to_mark_call(const Mark& mark, MarkAnswer answer, std::size_t call_size);
/// The answer to a refused call; `mark` comes from decode_mark_call. Empty if it would be longer
/// than the call. Also empty if the datagram has no schema of ours: two programs that both answer
/// unknown datagrams would never stop.
std::string answer_to_refused_call(const Mark& mark, MarkCallRefusal refusal,
                                   std::size_t call_size);

}  // namespace kinalign
