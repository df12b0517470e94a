// SPDX-License-Identifier: Apache-2.0
// Files compared with a string in memory that is written and read in the same way.
#include "tests/faulty_files.h"
#include "tests/folder.h"
#include "tests/seeds.h"

#include "kinalign/core/files.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <vector>

using namespace kinalign;

namespace {

std::string random_bytes(std::size_t n, std::mt19937_64& random) {
  std::string bytes(n, '\0');
  for (char& c : bytes) c = static_cast<char>(random());
  return bytes;
}

/// A file as it should be: reads after its end give zeros.
struct Model {
  std::string bytes;
  std::size_t next = 0;  // the offset of the next write()

  void put(std::size_t at, const std::string& piece) {
    bytes.resize(std::max(bytes.size(), at + piece.size()));
    std::copy(piece.begin(), piece.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at));
  }
  std::string part(std::size_t at, std::size_t n) const {
    return at < bytes.size() ? bytes.substr(at, n) : "";
  }
};

/// Does one random step on both; gives the file's answer.
Result<void> step(OutputFile& file, Model& model, std::mt19937_64& random) {
  const std::size_t at = random() % 3000;
  const std::string piece = random_bytes(1 + random() % 500, random);
  switch (random() % 4) {
    case 0:
      model.put(at, piece);
      return file.write_at(at, piece);
    case 1:
      model.bytes.resize(std::max(model.bytes.size(), at));
      return file.reserve(at);
    case 2: {
      std::string found(piece.size(), '?');
      const auto got = file.read_at(at, found);
      if (!got) return Failure(got.error());
      CHECK(found.substr(0, *got) == model.part(at, found.size()));
      return {};
    }
    default:
      model.put(model.next, piece);
      model.next += piece.size();
      return file.write(piece);
  }
}

/// A whole file in random steps.
Result<void> write_file(FileSystem& files, const std::string& path, Model& model,
                        std::mt19937_64& random) {
  OutputFile file = KA_TRY(OutputFile::create(files, path, Overwrite::yes));
  for (std::size_t n = 1 + random() % 12; n > 0; --n) KA_TRY(step(file, model, random));
  return file.commit();
}

}  // namespace

TEST_CASE("bytes written anywhere, in any order and in small pieces, can be read back") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const FreshFolder folder;
    FaultyFiles files;
    files.nameless = random() % 2 == 0;
    files.most = 1 + random() % 600;
    Model model;
    REQUIRE(write_file(files, folder / "out", model, random));
    CHECK(folder.read("out") == model.bytes);
    CHECK(folder.names().size() == 1);
  }
}

TEST_CASE("whichever call of whatever writing fails, the old file stands there or the whole new") {
  for (const auto seed : fresh_seeds(200)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const FreshFolder folder;
    folder.write("out", "old");
    FaultyFiles files;
    files.nameless = random() % 2 == 0;
    files.most = 1 + random() % 600;
    files.fail_at = 1 + static_cast<int>(random() % 30);
    Model model;
    const auto written = write_file(files, folder / "out", model, random);
    CHECK(folder.names() == std::vector<std::string>{"out"});
    CHECK(folder.read("out") == (written ? model.bytes : "old"));
    if (!written) CHECK(files.failed());
  }
}

TEST_CASE("if two write to one name, the last to finish has the complete file") {
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const FreshFolder folder;
    PosixFiles files;
    Model one, other;
    auto first = OutputFile::create(files, folder / "out", Overwrite::yes);
    auto second = OutputFile::create(files, folder / "out", Overwrite::yes);
    REQUIRE(first);
    REQUIRE(second);
    for (int i = 0; i < 10; ++i) {
      REQUIRE(step(*first, one, random));
      REQUIRE(step(*second, other, random));
    }
    REQUIRE(second->commit());
    CHECK(folder.read("out") == other.bytes);
    REQUIRE(first->commit());
    CHECK(folder.read("out") == one.bytes);
    CHECK(folder.names().size() == 1);
  }
}

TEST_CASE("a file reads the same however short the reads are, and whatever else is read") {
  for (const auto seed : fresh_seeds(50)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const FreshFolder folder;
    const std::string bytes = random_bytes(random() % 20000, random);
    FaultyFiles files;
    files.first_read = 1 + random() % 300;
    files.most = 1 + random() % 300;
    auto file = InputFile::open(files, folder.write("data", bytes));
    REQUIRE(file);
    std::string found;
    for (;;) {
      const std::size_t at = random() % 25000;
      std::string beside(random() % 700, '?');
      const auto got = file->read_at(at, beside);
      REQUIRE(got);
      CHECK(beside.substr(0, *got) == (at < bytes.size() ? bytes.substr(at, beside.size()) : ""));
      const auto piece = file->next();
      REQUIRE(piece);
      if (piece->empty()) break;
      found += *piece;
    }
    CHECK(found == bytes);
  }
}
