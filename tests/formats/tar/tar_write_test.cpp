// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/tar/tar_write.h"

#include "tests/folder.h"
#include "tests/formats/tar/shards.h"
#include "tests/seeds.h"
#include "tests/witness.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <string>

using namespace kinalign;

namespace {

std::string error_of(const Result<void>& result) { return result ? "" : to_string(result.error()); }

}  // namespace

TEST_CASE("a member is a header of 512 bytes, its bytes, and zeros up to the next block") {
  std::string bytes;
  TarWriter tar(into(bytes));
  REQUIRE(tar.add("a.cls", "7"));
  REQUIRE(tar.finish());
  REQUIRE(bytes.size() == 4 * 512);
  CHECK(bytes.substr(0, 6) == std::string("a.cls\0", 6));
  CHECK(bytes.substr(100, 57) == std::string("0000644\0"
                                             "0000000\0"
                                             "0000000\0"
                                             "00000000001\0"
                                             "00000000000\0"
                                             "010117\0 "
                                             "0",
                                             57));
  CHECK(bytes.substr(257, 8) == std::string("ustar\0"
                                            "00",
                                            8));
  CHECK(bytes.substr(512, 2) == std::string("7\0", 2));
  CHECK(bytes.find_first_not_of('\0', 513) == std::string::npos);
}

TEST_CASE("Python's tarfile and GNU tar read every member, long names and empty files too") {
  const FreshFolder folder;
  folder.write("shard.tar", twenty_samples());
  for (const std::uint64_t seed : fresh_seeds(3)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    std::string bytes, expected;
    TarWriter tar(into(bytes));
    for (int k = 0; k < 30; ++k) {
      std::string name = "m" + std::to_string(k) + std::string(random() % 300, 'x');
      if (random() % 3 == 0) name = "folder/" + name;
      std::string content(random() % 2000, '\0');
      for (char& c : content) c = static_cast<char>(random());
      REQUIRE(tar.add(name, content));
      expected += name + " " + std::to_string(content.size()) + " " +
                  std::to_string(checksum(content)) + "\n";
    }
    REQUIRE(tar.finish());
    folder.write("small.tar", bytes);
    folder.write("expected.txt", expected);
    CHECK(run_witness("tar_read.py", folder.path()) == 0);
  }
}

TEST_CASE("a member above 8 GiB is read by Python's tarfile with its size") {
  const FreshFolder folder;
  folder.write("shard.tar", twenty_samples());
  std::string small;
  TarWriter empty(into(small));
  REQUIRE(empty.finish());
  folder.write("small.tar", small);
  folder.write("expected.txt", "");
  const std::string path = folder / "large.tar";
  std::ofstream file(path, std::ios::binary);
  std::uint64_t size = 0;
  const std::string_view zeros("", std::size_t{1} << 33);  // never read, see below
  TarWriter tar([&](std::string_view bytes) -> Result<void> {
    size += bytes.size();
    if (bytes.data() == zeros.data()) {  // holes instead of 8 GiB
      file.seekp(static_cast<std::streamoff>(size));
    } else {
      file << bytes;
    }
    return {};
  });
  REQUIRE(tar.add("before", "1"));
  REQUIRE(tar.add("large.npy", zeros));
  REQUIRE(tar.add("behind", "2"));
  REQUIRE(tar.finish());
  file.close();
  CHECK(std::filesystem::file_size(path) == size);
  CHECK(run_witness("tar_read.py", folder.path()) == 0);
}

TEST_CASE("names that lead out are refused") {
  std::string bytes;
  TarWriter tar(into(bytes));
  for (const std::string& name :
       {std::string(), std::string("/etc/passwd"), std::string("a/../../b"), std::string(".."),
        std::string(1001, 'x'), std::string("a\0b", 3)}) {
    CAPTURE(name);
    CHECK(error_of(tar.add(name, ""))
              .starts_with("expected a relative name of 1 to 1000 bytes in a tar"));
  }
  CHECK(error_of(tar.add("a..b/c", "")) == "");
}

TEST_CASE("a sink that refuses ends the archive") {
  TarWriter tar([](std::string_view) -> Result<void> {
    return Failure(Error{"", 0, "room", "none"});
  });
  CHECK(error_of(tar.add("a", "1")) == "expected room, found none");
}
