// SPDX-License-Identifier: Apache-2.0
// Writes a WebDataset shard: a tar file in which the members of a sample follow each other. Layout:
// docs/formats/webdataset.md.
#pragma once

#include "kinalign/formats/tar/tar_write.h"

#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <string_view>

namespace kinalign {

/// A member of a sample. `ending` is the part of its name after the key, such as "positions.npy".
/// The full name is key.ending.
struct ShardMember {
  std::string_view ending, bytes;
};

/// Writes samples. The members of a sample follow each other, because readers begin a new sample at
/// each new key.
class ShardWriter {
 public:
  explicit ShardWriter(FileSink sink) : tar_(std::move(sink)) {}

  /// Adds a sample. In WebDataset the key is the part of a name before its first dot. Fails if the
  /// key is empty, contains a dot or a slash, or occurred before. Fails if an ending is empty or
  /// repeated, contains a slash, or begins with a dot.
  Result<void> add(std::string_view key, std::span<const ShardMember> members);
  Result<void> finish() { return tar_.finish(); }

  std::uint64_t samples() const { return keys_.size(); }

  // Keys of this shard. A key may occur only once, because readers would join two samples with the
  // same key.
 private:
  TarWriter tar_;
  std::set<std::string, std::less<>> keys_;
};

/// The name of a shard, for example "walk-000012.tar".
std::string shard_name(std::string_view stem, std::uint64_t number);

}  // namespace kinalign
