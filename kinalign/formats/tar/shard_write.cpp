// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/tar/shard_write.h"

#include <fmt/format.h>

namespace kinalign {

namespace {

Failure refuse_sample(std::string expected, std::string_view found) {
  return refuse(std::move(expected), "'" + shown(found) + "'");
}

}  // namespace

Result<void> ShardWriter::add(std::string_view key, std::span<const ShardMember> members) {
  if (key.empty() || key.find_first_of("./") != std::string_view::npos) {
    return refuse_sample("a sample's key without dots and slashes", key);
  }
  if (keys_.contains(key)) return refuse_sample("each sample's key once in a shard", key);
  if (members.empty()) return refuse_sample("a sample with a member", key);
  // All members are checked before the first one is written, so that a refused sample writes
  // nothing.
  std::set<std::string_view> endings;
  for (const ShardMember& member : members) {
    const bool good = !member.ending.empty() && member.ending.front() != '.' &&
                      member.ending.find('/') == std::string_view::npos;
    if (!good) return refuse_sample("an ending such as positions.npy", member.ending);
    if (!endings.insert(member.ending).second) {
      return refuse_sample("each ending once in a sample", member.ending);
    }
  }
  for (const ShardMember& member : members) {
    KA_TRY(tar_.add(fmt::format("{}.{}", key, member.ending), member.bytes));
  }
  // The key is stored only if all members were written.
  keys_.emplace(key);
  return {};
}

std::string shard_name(std::string_view stem, std::uint64_t number) {
  return fmt::format("{}-{:06}.tar", stem, number);
}

}  // namespace kinalign
