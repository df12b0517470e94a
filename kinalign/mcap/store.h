// SPDX-License-Identifier: Apache-2.0
// Stores an MCAP file in an OutputFile, which gets its name only when it is complete. This is for
// files that are written at once. The recorder appends to a GrowingFile instead.
#pragma once

#include "kinalign/core/files.h"
#include "kinalign/mcap/writer.h"

namespace kinalign {

/// A store that writes to `out`. `out` must exist longer than the store.
inline McapStore mcap_store(OutputFile& out) {
  return {[&out](std::string_view bytes) { return out.write(bytes); },
          [&out](std::uint64_t at, std::span<char> to) -> Result<void> {
            const std::size_t got = KA_TRY(out.read_at(at, to));
            if (got == to.size()) return {};
            return Failure(Error{out.path(), 0, "the bytes that were written", "fewer"});
          }};
}

}  // namespace kinalign
