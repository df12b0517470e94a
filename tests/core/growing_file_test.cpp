// SPDX-License-Identifier: Apache-2.0
#include "kinalign/core/growing_file.h"

#include "tests/faulty_files.h"
#include "tests/folder.h"

#include <doctest/doctest.h>

using namespace kinalign;

TEST_CASE("a growing file has its name and its bytes from the first append on") {
  const FreshFolder folder;
  PosixFiles files;
  auto file = GrowingFile::create(files, folder / "a");
  REQUIRE(file);
  CHECK(file->append("one "));
  CHECK(folder.read("a") == "one ");
  CHECK(file->append("two"));
  CHECK(file->sync());
  CHECK(folder.read("a") == "one two");
  std::string back(3, ' ');
  CHECK(file->read_at(4, back));
  CHECK(back == "two");
  CHECK(file->cut(4));
  CHECK(file->append("2"));
  file->close();
  CHECK(folder.read("a") == "one 2");
}

TEST_CASE("a growing file never takes the place of another") {
  const FreshFolder folder;
  folder.write("a", "kept");
  PosixFiles files;
  const auto file = GrowingFile::create(files, folder / "a");
  REQUIRE(!file);
  CHECK(to_string(file.error()) ==
        (folder / "a") + ": expected no file of that name, found an existing file");
  CHECK(folder.read("a") == "kept");
}

TEST_CASE("reading behind a growing file's end fails") {
  const FreshFolder folder;
  PosixFiles files;
  auto file = GrowingFile::create(files, folder / "a");
  REQUIRE(file);
  CHECK(file->append("one"));
  std::string back(4, ' ');
  CHECK(!file->read_at(0, back));
}

TEST_CASE("whichever call fails, a growing file holds whole appends alone") {
  for (const std::size_t most : {SIZE_MAX, std::size_t{2}}) {  // short writes, too
    for (const int code : {ENOSPC, EIO, EINTR}) {
      for (int fail_at = 1;; ++fail_at) {
        CAPTURE(code);
        CAPTURE(fail_at);
        const FreshFolder folder;
        FaultyFiles files;
        files.fail_at = fail_at;
        files.code = code;
        files.most = most;
        std::string expected;
        {
          auto file = GrowingFile::create(files, folder / "a");
          if (file) {
            for (const std::string text : {"one ", "twos ", "three"}) {
              if (file->append(text)) expected += text;
            }
            file->close();
            CHECK(folder.read("a") == expected);
          }
        }
        if (code == EINTR) CHECK(expected == "one twos three");
        if (!files.failed()) break;
      }
    }
  }
}

TEST_CASE("if an append and the following truncation fail, the next append repairs the file") {
  struct TwoFail : PosixFiles {
    bool failing = false;
    ssize_t write_at(int fd, const void* data, std::size_t size, off_t at) override {
      if (failing && size <= 3) {
        errno = EIO;
        return -1;
      }
      return PosixFiles::write_at(fd, data, failing ? std::size_t{6} : size, at);
    }
    int truncate(int fd, off_t size) override {
      if (!failing) return PosixFiles::truncate(fd, size);
      errno = EIO;
      return -1;
    }
  };
  const FreshFolder folder;
  TwoFail files;
  auto file = GrowingFile::create(files, folder / "a");
  REQUIRE(file);
  CHECK(file->append("one "));
  files.failing = true;
  CHECK(!file->append("two three"));
  files.failing = false;
  CHECK(folder.read("a") == "one two th");
  CHECK(file->append("2"));
  CHECK(folder.read("a") == "one 2");
}
