// SPDX-License-Identifier: Apache-2.0
// An MCAP file that is whole or not there at all.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/mcap/writer.h"

namespace kinalign {

/// Writes to `out`, which has to stay.
inline McapStore mcap_store(OutputFile& out) {
  return {[&out](std::string_view bytes) { return out.write(bytes); },
          [&out](std::uint64_t at, std::span<char> to) -> Result<void> {
            const std::size_t got = KA_TRY(out.read_at(at, to));
            if (got == to.size()) return {};
            return Failure(Error{out.path(), 0, "the bytes that were written", "fewer"});
          }};
}

}  // namespace kinalign
