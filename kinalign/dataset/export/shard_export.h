// SPDX-License-Identifier: Apache-2.0
// Writes takes as samples of WebDataset shards: docs/formats/webdataset.md.
#pragma once

#include "kinalign/dataset/export/exported_take.h"
#include "kinalign/dataset/export/take_files.h"
#include "kinalign/formats/tar/shard_write.h"

#include <map>
#include <memory>

namespace kinalign {

/// Further facts for the JSON of a sample, in addition to those of the take.
struct SampleFacts {
  std::string class_id, part;
};

/// One export to shards. Each part of a split has its own open shard, so samples of two parts are
/// never in one file. If finish() is not called, the open shards stay incomplete.
class ShardExport {
 public:
  /// A shard ends after the sample with which it has at least `shard_bytes` bytes.
  ShardExport(FileSystem& files, std::string folder,
              std::uint64_t shard_bytes = std::uint64_t{256} << 20)
      : files_(files), folder_(std::move(folder)), shard_bytes_(shard_bytes) {}

  /// Adds a take as one sample: each array as STREAM_ARRAY.npy, the stamps as time_ns.npy, and a
  /// JSON. Names of shards begin with the take's part: train-000000.tar. One whole take is in
  /// memory.
  Result<FilesMade> add(ExportedTake& take, const SampleFacts& facts);
  Result<FilesMade> finish();

 private:
  struct Shard;
  Result<Shard*> shard_of(const std::string& part);
  Result<void> end(Shard& shard, FilesMade& made);

  FileSystem& files_;
  std::string folder_;
  std::uint64_t shard_bytes_;
  std::map<std::string, std::shared_ptr<Shard>> open_;
  std::map<std::string, std::uint64_t> numbers_;  // number of the next shard, by part
};

}  // namespace kinalign
