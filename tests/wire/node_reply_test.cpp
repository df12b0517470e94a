// SPDX-License-Identifier: Apache-2.0
#include "kinalign/wire/node_reply.h"

#include "tests/wire/node_cases.h"

#include "kinalign/wire/node_layout.h"

#include <doctest/doctest.h>

using namespace kinalign;

TEST_CASE("a reply is never longer than the smallest frame with the same key") {
  CHECK(encoded(NodeReply{}, nullptr).size() == 44);
  CHECK(encoded(NodeReply{}, &counted_key).size() == 52);
  CHECK(encoded(NodeFrame{}, nullptr).size() == 52);
  CHECK(encoded(NodeFrame{}, &counted_key).size() == 60);
}

TEST_CASE("a frame that is sent back to its node is no reply") {
  CHECK(fate<NodeReply>(encoded(NodeFrame{}, &counted_key), &counted_key) == "wrong_type");
}

TEST_CASE("a reply with a state, flag or reserved byte of a later version is refused") {
  for (const std::size_t at : {20, 21, 22, 23}) {
    CAPTURE(at);
    Bytes bytes = encoded(NodeReply{}, nullptr);
    bytes[at] |= 2;
    REQUIRE(!seal(bytes, nullptr).empty());
    CHECK(fate<NodeReply>(bytes, nullptr) == "stray_bits");
  }
}
