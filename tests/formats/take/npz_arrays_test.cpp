// SPDX-License-Identifier: Apache-2.0
// NPZ of any arrays, in any pieces, as numpy reads it.
#include "tests/folder.h"
#include "tests/seeds.h"
#include "tests/witness.h"

#include "kinalign/formats/take/npz.h"

#include <doctest/doctest.h>

#include <array>
#include <string>
#include <vector>

using namespace kinalign;

namespace {

struct Given {
  std::vector<NpzArray> arrays;
  std::vector<std::string> bytes;  // [arrays]
};

std::string any_bytes(std::uint64_t size, std::mt19937_64& random) {
  std::string out(size, '\0');
  for (char& c : out) c = static_cast<char>(random());
  return out;
}

/// One to six arrays of any type and shape, empty and scalar ones too.
Given any_arrays(std::mt19937_64& random) {
  constexpr std::array<Stored, 5> types{Stored::float32, Stored::float64, Stored::int64,
                                        Stored::int32, Stored::uint8};
  Given out;
  for (std::uint64_t n = 1 + random() % 6; n > 0; --n) {
    std::vector<std::uint64_t> shape;
    for (std::uint64_t rank = random() % 5; rank > 0; --rank) shape.push_back(random() % 9);
    out.arrays.push_back(npz_numbers("array_" + std::to_string(n), types.at(random() % 5), shape));
    out.bytes.push_back(any_bytes(out.arrays.back().bytes(), random));
  }
  return out;
}

/// Writes them a piece of any array at a time, and lists them for the witness.
void write(const Given& given, const FreshFolder& folder, const std::string& name,
           std::mt19937_64& random) {
  PosixFiles files;
  auto writer = NpzWriter::create(files, folder / (name + ".npz"), Overwrite::no, given.arrays);
  REQUIRE_MESSAGE(writer, (writer ? "" : to_string(writer.error())));
  std::vector<std::size_t> at(given.arrays.size(), 0);
  for (bool left = true; left;) {
    left = false;
    for (std::size_t i = 0; i < at.size(); ++i) {
      const std::string piece = given.bytes[i].substr(at[i], 1 + random() % 5000);
      if (piece.empty()) continue;
      REQUIRE(writer->append(i, piece));
      at[i] += piece.size();
      left = true;
    }
  }
  REQUIRE(writer->finish());
  std::string list;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const NpzArray& array = given.arrays[i];
    list += array.name + " " + array.descr;
    for (const std::uint64_t size : array.shape) list += " " + std::to_string(size);
    list += "\n";
    folder.write(name + "." + array.name + ".bin", given.bytes[i]);
  }
  folder.write(name + ".txt", list);
}

}  // namespace

TEST_CASE("numpy finds every array of any NPZ with its type, shape and bytes") {
  const FreshFolder folder;
  std::size_t n = 0;
  for (const std::uint64_t seed : fresh_seeds(30)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    write(any_arrays(random), folder, "npz" + std::to_string(n++), random);
  }
  CHECK(run_witness("npz_same.py", folder.path()) == 0);
}

TEST_CASE("an array's bytes are its values' times their sizes; a scalar is one value") {
  CHECK(npz_numbers("a", Stored::float32, {5, 3}).bytes() == 60);
  CHECK(npz_numbers("a", Stored::float64, {}).bytes() == 8);
  CHECK(npz_numbers("a", Stored::int64, {0, 7}).bytes() == 0);
  CHECK(npz_numbers("a", Stored::int32, {2}).descr == "<i4");
  CHECK(npz_numbers("a", Stored::uint8, {2}).descr == "|u1");
}
