// SPDX-License-Identifier: Apache-2.0
#include "kinalign/wire/bytes.h"

#include <doctest/doctest.h>

#include <array>

using namespace kinalign;

TEST_CASE("fields stand in network order, one behind another") {
  std::array<std::uint8_t, 15> bytes{};
  ByteWriter writer(bytes);
  writer.put(std::uint8_t{0x01});
  writer.put(std::uint16_t{0x0203});
  writer.put(std::uint64_t{0x0405060708090a0b});
  writer.put_float(1.0F);
  CHECK(writer.complete());
  CHECK(writer.written() == 15);
  CHECK(bytes == std::array<std::uint8_t, 15>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 0x3f, 0x80, 0, 0});

  ByteReader reader(bytes);
  CHECK(reader.take<std::uint8_t>() == 0x01);
  CHECK(reader.take<std::uint16_t>() == 0x0203);
  CHECK(reader.take<std::uint64_t>() == 0x0405060708090a0b);
  CHECK(reader.take_float() == 1.0F);
  CHECK(reader.complete());
  CHECK(reader.left() == 0);
}

TEST_CASE("a field past the end is zero, nothing after it is read and the reader reports it") {
  const std::array<std::uint8_t, 3> bytes{1, 2, 3};
  ByteReader reader(bytes);
  CHECK(reader.take<std::uint32_t>() == 0);
  CHECK(!reader.complete());
  CHECK(reader.take<std::uint8_t>() == 0);
}

TEST_CASE("a field without space is not written and the writer reports it") {
  std::array<std::uint8_t, 3> bytes{};
  ByteWriter writer(bytes);
  writer.put(std::uint16_t{0x0102});
  writer.put(std::uint16_t{0x0304});
  CHECK(!writer.complete());
  CHECK(writer.written() == 2);
  CHECK(bytes == std::array<std::uint8_t, 3>{1, 2, 0});
}
