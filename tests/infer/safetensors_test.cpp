// SPDX-License-Identifier: Apache-2.0
#include "kinalign/infer/safetensors.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

using namespace kinalign;

namespace {

std::string file_of(const std::string& header, const std::string& data = "") {
  const std::uint64_t length = header.size();
  std::string out(8, '\0');
  std::memcpy(out.data(), &length, 8);
  return out + header + data;
}

std::string message(const std::string& bytes) {
  const auto file = read_safetensors(bytes, "m.safetensors");
  return file ? "no error" : to_string(file.error());
}

std::string one(const std::string& dtype, const std::string& shape, const std::string& offsets) {
  return R"({"a":{"dtype":)" + dtype + R"(,"shape":)" + shape + R"(,"data_offsets":)" + offsets +
         "}}";
}

}  // namespace

TEST_CASE("a file of tensors: written, these bytes; read, the same tensors") {
  TensorFile file;
  file.metadata = {{"made by", "a test"}};
  file.tensors["b"] = {{2, 1}, {1.0F, -2.0F}};
  file.tensors["a"] = {{}, {0.5F}};
  const std::string bytes = write_safetensors(file);
  const std::string header = R"({"__metadata__":{"made by":"a test"},)"
                             R"("a":{"dtype":"F32","shape":[],"data_offsets":[0,4]},)"
                             R"("b":{"dtype":"F32","shape":[2,1],"data_offsets":[4,12]}})";
  const std::string blanks((8 - header.size() % 8) % 8, ' ');
  CHECK(bytes ==
        file_of(header + blanks, {"\x00\x00\x00\x3f\x00\x00\x80\x3f\x00\x00\x00\xc0", 12}));
  const auto again = read_safetensors(bytes, "m.safetensors");
  REQUIRE(again);
  CHECK(again->metadata == file.metadata);
  CHECK(again->tensors == file.tensors);
}

TEST_CASE("half floats and bfloats are widened") {
  const auto halves =
      read_safetensors(file_of(one(R"("F16")", "[6]", "[0,12]"),
                               {"\x00\x3c\x00\xc0\x01\x00\x00\x7c\x00\x80\xff\x7b", 12}),
                       "m");
  REQUIRE(halves);
  const auto& values = halves->tensors.at("a").values;
  CHECK(values == std::vector<float>{1.0F, -2.0F, std::ldexp(1.0F, -24),
                                     std::numeric_limits<float>::infinity(), -0.0F, 65504.0F});
  CHECK(std::signbit(values[4]));
  const auto bfloats =
      read_safetensors(file_of(one(R"("BF16")", "[2]", "[0,4]"), {"\x80\x3f\x49\xc0", 4}), "m");
  REQUIRE(bfloats);
  CHECK(bfloats->tensors.at("a").values == std::vector<float>{1.0F, -3.140625F});
}

TEST_CASE("a tensor without values has its place") {
  const auto file = read_safetensors(file_of(one(R"("F32")", "[0,3]", "[0,0]")), "m");
  REQUIRE(file);
  CHECK(file->tensors.at("a").shape == std::vector<std::size_t>{0, 3});
  CHECK(write_safetensors(*file).size() % 8 == 0);
}

TEST_CASE("a header that is cut, too long or no object is refused") {
  CHECK(message("1234567") ==
        "m.safetensors: expected 8 bytes that give the length of a SafeTensors header, found 7 "
        "bytes");
  CHECK(message(std::string("\x01\x00\x00\x01\x00\x00\x00\x00", 8)) ==
        "m.safetensors: expected a SafeTensors header of at most 16 MB, found 16777217 bytes");
  CHECK(message(file_of("{}").substr(0, 9)) ==
        "m.safetensors: expected a header of 2 bytes, found 1");
  CHECK(message(file_of("[]")) == "m.safetensors: expected '{' at byte 8, found \"[]\"");
  CHECK(message(file_of("{\"a\":}")) ==
        "m.safetensors: expected JSON, found a syntax error at byte 6");
  CHECK(message(file_of("{\"a\":1e999}")) ==
        "m.safetensors: expected JSON, found a number beyond the range of a double");
}

TEST_CASE("the header's entries are read strictly") {
  CHECK(message(file_of(R"({"a":{"dtype":"F32"}})")) ==
        "m.safetensors: expected dtype, shape and data_offsets of tensor \"a\", found "
        R"({"dtype":"F32"})");
  CHECK(message(file_of(one(R"("I64")", "[1]", "[0,8]"), "12345678")) ==
        "m.safetensors: expected values of type F32, F16 or BF16 in tensor \"a\", found \"I64\"");
  CHECK(message(file_of(one(R"("F32")", "[-1]", "[0,4]"), "1234")) ==
        "m.safetensors: expected whole numbers as shape of tensor \"a\", found [-1]");
  CHECK(message(file_of(one(R"("F32")", "[1]", "[0,4,8]"), "1234")) ==
        "m.safetensors: expected two whole numbers as data_offsets of tensor \"a\", found [0,4,8]");
  CHECK(message(file_of(R"({"__metadata__":{"a":1}})")) ==
        "m.safetensors: expected texts in __metadata__, found a JSON number as \"a\"");
  CHECK(message(file_of(R"({"__metadata__":{},"__metadata__":{}})")) ==
        "m.safetensors: expected each key of a JSON object once, found \"__metadata__\" twice");
}

TEST_CASE("tensors lie one behind the other up to the end of the file") {
  CHECK(message(file_of(one(R"("F32")", "[1]", "[4,8]"), "12345678")) ==
        "m.safetensors: expected tensor \"a\" to begin at byte 0, found byte 4");
  CHECK(message(file_of(one(R"("F32")", "[2]", "[0,4]"), "1234")) ==
        "m.safetensors: expected 8 bytes of tensor \"a\", found bytes 0 to 4");
  CHECK(message(file_of(one(R"("F32")", "[1]", "[0,4]"), "12345")) ==
        "m.safetensors: expected 4 bytes of tensors after the header, found 5");
  CHECK(message(file_of(one(R"("F32")", "[1]", "[0,4]"), "123")) ==
        "m.safetensors: expected 4 bytes of tensors after the header, found 3");
  CHECK(message(file_of(one(R"("F32")", "[4611686018427387904]", "[0,0]"))) ==
        "m.safetensors: expected more than 2^64 bytes of tensor \"a\", found bytes 0 to 0");
}
