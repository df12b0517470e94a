// SPDX-License-Identifier: Apache-2.0
// The ONNX writer. tests/infer/network_check.py reads its files with other programs.
#include "kinalign/infer/onnx.h"

#include "tests/infer/networks.h"

#include "kinalign/infer/protobuf.h"

#include <doctest/doctest.h>

using namespace kinalign;

TEST_CASE("a protobuf message has these bytes") {
  ProtobufMessage inner;
  inner.add(1, std::int64_t{300}).add(2, 1.0F);
  const ProtobufMessage message = ProtobufMessage().add(20, std::int64_t{-1}).add(3, inner);
  const std::string_view expected(
      "\xa0\x01\xff\xff\xff\xff\xff\xff\xff\xff\xff\x01"  // field 20, varint: 2^64 - 1
      "\x1a\x08\x08\xac\x02\x15\x00\x00\x80\x3f",         // field 3, 8 bytes: the inner message
      22);
  CHECK(message.bytes() == expected);
}

TEST_CASE("the same network gives the same ONNX bytes") {
  const Architecture architecture = offline_architecture();
  const Tensors tensors = random_tensors(architecture, 1);
  const auto first = onnx_of(architecture, tensors, {});
  REQUIRE(first);
  CHECK(onnx_of(architecture, tensors, {}).value_or("") == *first);
}

TEST_CASE("ONNX is refused where the network would be") {
  const auto none = onnx_of({1, {layer(linear, 1)}}, {}, {});
  REQUIRE_FALSE(none);
  CHECK(to_string(none.error()) == "expected tensor 0.weight [1,1], found none");
  CHECK_FALSE(onnx_of({0, {}}, {}, {}));
}
