// SPDX-License-Identifier: Apache-2.0
#include "kinalign/sources/input_facts.h"

#include "kinalign/core/hash.h"

namespace kinalign {

Result<InputFacts> facts_of(FileSystem& files, const std::string& path, std::string_view doing,
                            const Progress& progress) {
  InputFile file = KA_TRY(InputFile::open(files, path));
  Sha256 hash;
  std::uint64_t bytes = 0;
  for (;;) {
    const std::string_view piece = KA_TRY(file.next());
    // Progress is reported after each block, so that the user can interrupt long reading.
    if (piece.empty()) return InputFacts{std::string(file_name(path)), hash.hex(), bytes};
    bytes += piece.size();
    hash.update(piece);
    if (!go_on(progress, doing, bytes, file.size())) return Failure(interruption(path));
  }
}

}  // namespace kinalign
