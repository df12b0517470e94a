// SPDX-License-Identifier: Apache-2.0
// Our own call for marks, a datagram with a JSON object: docs/formats/marks.md.
#pragma once

#include "kinalign/io/mark.h"

#include <span>

namespace kinalign {

inline constexpr std::size_t most_mark_call = 1200;

enum class [[nodiscard]] MarkCallRefusal : std::uint8_t{
    none, too_long, bad_json, wrong_schema, wrong_kind, wrong_id, wrong_latency, wrong_text};
inline constexpr std::size_t mark_call_refusals = 8;

/// As in --json: "wrong_id".
const char* name_of(MarkCallRefusal refusal);

/// After a refusal `mark` is as new.
MarkCallRefusal decode_mark_call(std::string_view datagram, Mark& mark);

/// As it is sent.
std::string encode_mark_call(const Mark& mark);

enum class MarkAnswer : std::uint8_t { fresh, repeat };
/// What is answered to a call of `call_size` bytes; empty where it would be longer than that.
std::string answer_to_mark_call(const Mark& mark, MarkAnswer answer, std::size_t call_size);

}  // namespace kinalign
