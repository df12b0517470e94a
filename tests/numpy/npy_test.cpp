// SPDX-License-Identifier: Apache-2.0
// Headers as NumPy writes them; arrays of NumPy itself: tests/data/fuzz/npy_fuzz.
#include "kinalign/numpy/npy.h"

#include "tests/folder.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

std::string npy(const std::string& header, const std::string& values) {
  std::string out("\x93NUMPY\1\0", 8);
  out += static_cast<char>(header.size() % 256);
  out += static_cast<char>(header.size() / 256);
  return out + header + values;
}

std::string header_fault(const std::string& header) {
  const std::string bytes = npy(header, "");
  const auto read = read_npy(bytes, "a.npy");
  return read ? "" : to_string(read.error());
}

/// An array of a file that numpy wrote; it views the bytes of the file.
struct OfNumpy {
  std::string file;
  NpyArray array;

  explicit OfNumpy(const std::string& name)
      : file(bytes_in(KINALIGN_SOURCE_DIR "/tests/data/fuzz/npy_fuzz/" + name)) {
    const auto read = read_npy(file, name);
    REQUIRE_MESSAGE(read, name);
    array = *read;
  }
};

}  // namespace

TEST_CASE("arrays that numpy wrote are read with their shape and values") {
  const OfNumpy floats("float.npy"), integers("int.npy"), texts("text.npy");
  CHECK(floats.array.header.shape == std::vector<std::uint64_t>{2, 3});
  CHECK(number_at(floats.array, 5) == 5.0);
  CHECK(integer_at(integers.array, 1) == -2);
  CHECK(number_at(integers.array, 1) == -2.0);
  CHECK(text_at(texts.array, 0) == "walk");
  CHECK(text_at(texts.array, 1) == "größe");
  CHECK(OfNumpy("scalar.npy").array.header.values() == 1);
  CHECK(OfNumpy("empty.npy").array.header.values() == 0);
}

TEST_CASE("true and false are read as numbers") {
  const std::string file =
      npy("{'descr': '|b1', 'fortran_order': False, 'shape': (2,), }", std::string("\0\1", 2));
  const auto flags = read_npy(file, "a.npy");
  REQUIRE(flags);
  CHECK(number_at(*flags, 0) == 0.0);
  CHECK(number_at(*flags, 1) == 1.0);
}

TEST_CASE("an order, a kind or a header that is not ours is refused") {
  CHECK(header_fault("{'descr': '<f8', 'fortran_order': True, 'shape': (2, 3), }")
            .starts_with("a.npy: expected an NPY of numbers or texts, little-endian, in C order"));
  CHECK_FALSE(header_fault("{'descr': '>f8', 'fortran_order': False, 'shape': (0,), }").empty());
  CHECK_FALSE(header_fault("{'descr': '|O', 'fortran_order': False, 'shape': (0,), }").empty());
  CHECK_FALSE(header_fault("{'descr': '<U0', 'fortran_order': False, 'shape': (0,), }").empty());
  CHECK_FALSE(header_fault("{'descr': '<f8', 'fortran_order': False, }").empty());
  CHECK_FALSE(header_fault("{'descr': '<f8', 'descr': '<f8', 'shape': (0,), }").empty());
  CHECK_FALSE(header_fault("{'descr': '<f8', 'fortran_order': False, 'shape': (0,), } x").empty());
  CHECK_FALSE(header_fault("{'descr': '<f8', 'fortran_order': False, 'shape': (-1,), }").empty());
  CHECK(header_fault("{'descr': '<f8', 'fortran_order': False, 'shape': (0,), }").empty());
}

TEST_CASE("an array has the bytes that its header promises, and never takes memory by them") {
  CHECK(header_fault("{'descr': '<f8', 'fortran_order': False, 'shape': (3,), }") ==
        "a.npy: expected 24 bytes of values, found 0");
  CHECK(header_fault(
            "{'descr': '<f8', 'fortran_order': False, 'shape': (4294967296, 4294967296), }") ==
        "a.npy: expected an array below 2^40 bytes, found a larger array");
  CHECK(header_fault("{'descr': '<f8', 'fortran_order': False, 'shape': (0, 99999999999999), }") ==
        "a.npy: expected an NPY of numbers or texts, little-endian, in C order, found "
        "{'descr': '<f8', 'fortran_order': False,...");
}
