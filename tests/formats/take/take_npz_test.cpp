// SPDX-License-Identifier: Apache-2.0
// NPZ files of takes, and of random arrays written in random pieces, as NumPy reads them.
#include "kinalign/formats/take/take_npz.h"

#include "tests/faulty_files.h"
#include "tests/folder.h"
#include "tests/formats/take/take_samples.h"
#include "tests/seeds.h"
#include "tests/witness.h"

#include <doctest/doctest.h>

#include <array>
#include <cerrno>
#include <string>
#include <vector>

using namespace kinalign;

namespace {

Result<void> write(FileSystem& files, const std::string& path, const Take& take, NpzNames names) {
  auto writer = KA_TRY(TakeNpzWriter::create(files, path, Overwrite::no, take.header, names));
  KA_TRY(writer.append(take.all));
  return writer.finish();
}

/// Leaves holes in place of pieces of 64 KiB, which are all zeros here: gigabytes without disk
/// space.
class SparseFiles final : public PosixFiles {
 public:
  ssize_t write_at(int fd, const void* data, std::size_t size, off_t at) override {
    return size == 65'536 ? 65'536 : PosixFiles::write_at(fd, data, size, at);
  }
  int allocate(int, off_t) override {
    errno = EOPNOTSUPP;
    return -1;
  }
  int sync(int) override { return 0; }
};

/// Only the first stream, as `convert` writes a BVH.
Take clip_alone(std::size_t frames) {
  Take take = sample_take(frames);
  take.header.groups.resize(1);
  take.all.rows.resize(1);
  return take;
}

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

/// Writes one piece of a random array at a time, and lists the arrays for the script of
/// tests/witness.
void write_arrays(const Given& given, const FreshFolder& folder, const std::string& name,
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

TEST_CASE("numpy opens a take and a clip alone") {
  const FreshFolder folder;
  PosixFiles files;
  REQUIRE(write(files, folder / "take.npz", sample_take(50), NpzNames::by_stream));
  REQUIRE(write(files, folder / "clip.npz", clip_alone(50), NpzNames::plain));
  REQUIRE(write(files, folder / "empty.npz", clip_alone(0), NpzNames::plain));
  CHECK(run_witness("npz_numpy.py", folder.path()) == 0);
}

TEST_CASE("an NPZ beyond 4 GB opens too") {
  const FreshFolder folder;
  SparseFiles files;
  const std::uint64_t rows = 65'537;  // rows of 64 KiB each
  auto writer = NpzWriter::create(
      files, folder / "large.npz", Overwrite::no,
      {npz_numbers("a", Stored::uint8, {rows, 65'536}), npz_numbers("b", Stored::int64, {2})});
  REQUIRE(writer);
  const std::string zeros(65'536, '\0');
  for (std::uint64_t r = 0; r < rows; ++r) REQUIRE(writer->append(0, zeros));
  const std::int64_t values[] = {7, -9};
  REQUIRE(writer->append(1, bytes_of(std::span<const std::int64_t>(values))));
  REQUIRE(writer->finish());
  CHECK(run_witness("npz_large.py", folder / "large.npz") == 0);
}

TEST_CASE("the same arrays give the same bytes, also from slabs") {
  const FreshFolder folder;
  PosixFiles files;
  REQUIRE(write(files, folder / "a.npz", sample_take(9), NpzNames::by_stream));
  REQUIRE(write(files, folder / "b.npz", sample_take(9), NpzNames::by_stream));
  CHECK(folder.read("a.npz") == folder.read("b.npz"));
}

TEST_CASE("whichever file call fails, no NPZ is left and the error names it") {
  bool went_through = false;
  for (int call = 1; !went_through; ++call) {
    CAPTURE(call);
    REQUIRE(call < 500);
    const FreshFolder folder;
    FaultyFiles files;
    files.fail_at = call;
    const auto done = write(files, folder / "a.npz", sample_take(9), NpzNames::by_stream);
    went_through = !files.failed();
    if (done) continue;
    CHECK(done.error().file == folder / "a.npz");
    CHECK(done.error().found == "No space left on device");
    CHECK(folder.empty());
  }
}

TEST_CASE("texts become numpy's UTF-32, an invalid byte stands for itself") {
  const NpzTexts texts = npz_texts("names", {"a", "H\xc3\xa4", "\xff", "\xe2\x82", ""});
  CHECK(texts.array.descr == "<U2");
  CHECK(texts.array.bytes() == 5 * 8);
  const std::u32string expected = {U'a', 0, U'H', 0xe4, 0xff, 0, 0xe2, 0x82, 0, 0};
  CHECK((texts.bytes == bytes_of(std::span<const char32_t>(expected))));
}

TEST_CASE("streams whose arrays would share a name in the file are refused") {
  const FreshFolder folder;
  PosixFiles files;
  Take take = sample_take(2);
  take.header.groups[1].name = take.header.groups[0].name + "_local";
  const auto written = write(files, folder / "a.npz", take, NpzNames::by_stream);
  REQUIRE(!written);
  CHECK(to_string(written.error()) ==
        (folder / "a.npz") +
            ": expected streams whose array names differ (STREAM_ARRAY.npy): rename a stream, "
            "found 'mocap_local_positions' twice");
  CHECK(folder.empty());
}

TEST_CASE("numpy finds every array of any NPZ with its type, shape and bytes") {
  const FreshFolder folder;
  std::size_t n = 0;
  for (const std::uint64_t seed : fresh_seeds(30)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    write_arrays(any_arrays(random), folder, "npz" + std::to_string(n++), random);
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
