// SPDX-License-Identifier: Apache-2.0
// Writes a WebDataset shard: a tar in which the members of a sample follow one another. Layout:
// docs/formats/webdataset.md.
#pragma once

#include "kinalign/formats/tar/tar_write.h"

#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <string_view>

namespace kinalign {

/// A member of a sample: its name after the key, such as "positions.npy", and its bytes. The full
/// name is key.ending.
struct ShardMember {
  std::string_view ending, bytes;
};

/// Members of a sample must follow each other, because readers begin a new sample at each new key.
class ShardWriter {
 public:
  explicit ShardWriter(FileSink sink) : tar_(std::move(sink)) {}

  /// Adds a sample. WebDataset uses the part of a name before its first dot as the key. Fails if
  /// the key is empty, has a dot or a slash, or occurred before. Fails if an ending is empty,
  /// repeated, has a slash or begins with a dot.
  Result<void> add(std::string_view key, std::span<const ShardMember> members);
  Result<void> finish() { return tar_.finish(); }

  std::uint64_t samples() const { return keys_.size(); }

  // The keys of this shard. Readers join neighbours of one key, so a key may occur once only.
 private:
  TarWriter tar_;
  std::set<std::string, std::less<>> keys_;
};

/// "walk-000012.tar"
std::string shard_name(std::string_view stem, std::uint64_t number);

}  // namespace kinalign
