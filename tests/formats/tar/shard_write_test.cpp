// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/tar/shard_write.h"

#include "tests/formats/tar/shards.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

using namespace kinalign;

namespace {

std::string refusal(ShardWriter& shard, std::string_view key,
                    const std::vector<ShardMember>& members) {
  const auto added = shard.add(key, members);
  return added ? "" : to_string(added.error());
}

}  // namespace

// tar_write_test.cpp with tests/witness/tar_read.py tests that WebDataset's own grouping finds the
// samples.

TEST_CASE("the same samples give the same bytes") { CHECK(twenty_samples() == twenty_samples()); }

TEST_CASE(
    "a key or an ending that WebDataset would cut elsewhere is refused, and nothing is written") {
  std::string bytes;
  ShardWriter shard(into(bytes));
  CHECK(refusal(shard, "", {{"json", ""}}) ==
        "expected a sample's key without dots and slashes, found ''");
  CHECK(refusal(shard, "a.b", {{"json", ""}}) ==
        "expected a sample's key without dots and slashes, found 'a.b'");
  CHECK(refusal(shard, "a/b", {{"json", ""}}) ==
        "expected a sample's key without dots and slashes, found 'a/b'");
  CHECK(refusal(shard, "a", {}) == "expected a sample with a member, found 'a'");
  CHECK(refusal(shard, "a", {{".json", ""}}) ==
        "expected an ending such as positions.npy, found '.json'");
  CHECK(refusal(shard, "a", {{"json", ""}, {"json", "1"}}) ==
        "expected each ending once in a sample, found 'json'");
  CHECK(bytes.empty());
  CHECK(refusal(shard, "a", {{"json", ""}}) == "");
  CHECK(refusal(shard, "a", {{"cls", ""}}) ==
        "expected each sample's key once in a shard, found 'a'");
  CHECK(shard.samples() == 1);
}

TEST_CASE("shards are numbered with six digits") {
  CHECK(shard_name("walk", 0) == "walk-000000.tar");
  CHECK(shard_name("walk", 1'234'567) == "walk-1234567.tar");
}
