// SPDX-License-Identifier: Apache-2.0
// A WebDataset shard: a tar in which the members of a sample stand one behind the other. Layout:
// docs/formats/webdataset.md.
#pragma once

#include "kinalign/formats/tar/tar_write.h"

#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <string_view>

namespace kinalign {

/// "positions.npy" and its bytes; the member is called key.ending.
struct ShardMember {
  std::string_view ending, bytes;
};

class ShardWriter {
 public:
  explicit ShardWriter(FileSink sink) : tar_(std::move(sink)) {}

  /// WebDataset takes what stands before the first dot of a name for the key. Fails where the key
  /// is empty, has a dot or a slash, or was there before; where an ending is empty, repeated or
  /// begins with a dot.
  Result<void> add(std::string_view key, std::span<const ShardMember> members);
  Result<void> finish() { return tar_.finish(); }

  std::uint64_t samples() const { return keys_.size(); }

 private:
  TarWriter tar_;
  std::set<std::string, std::less<>> keys_;
};

/// "walk-000012.tar"
std::string shard_name(std::string_view stem, std::uint64_t number);

}  // namespace kinalign
