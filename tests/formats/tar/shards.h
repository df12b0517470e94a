// SPDX-License-Identifier: Apache-2.0
// Shards for tests.
#pragma once

#include "kinalign/formats/tar/shard_write.h"

#include <zlib.h>

#include <array>
#include <stdexcept>
#include <string>
#include <string_view>

namespace kinalign {

inline FileSink into(std::string& bytes) {
  return [&bytes](std::string_view more) -> Result<void> {
    bytes += more;
    return {};
  };
}

inline unsigned long checksum(std::string_view bytes) {
  return crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size()));
}

/// The samples that tests/witness/tar_read.py expects in shard.tar.
inline std::string twenty_samples() {
  std::string bytes;
  ShardWriter shard(into(bytes));
  for (int k = 0; k < 20; ++k) {
    const std::string number = std::to_string(k),
                      key = "take0001_" + std::string(5 - number.size(), '0') + number;
    const std::string positions(static_cast<std::size_t>(k), static_cast<char>(k));
    const std::array<ShardMember, 3> members{
        {{"positions.npy", positions}, {"json", "{}"}, {"cls", number}}};
    if (!shard.add(key, members)) throw std::runtime_error("a sample was refused");
  }
  if (!shard.finish()) throw std::runtime_error("the shard could not be finished");
  return bytes;
}

}  // namespace kinalign
