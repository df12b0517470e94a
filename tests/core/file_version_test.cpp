// SPDX-License-Identifier: Apache-2.0
#include "kinalign/core/file_version.h"

#include "tests/folder.h"

#include <doctest/doctest.h>

#include <chrono>
#include <filesystem>

using namespace kinalign;

TEST_CASE("a file that grows, shrinks or is replaced has another version") {
  const FreshFolder folder;
  const std::string path = folder.write("a", "1234");
  const auto first = version_of(path);
  REQUIRE(first);
  CHECK(version_of(path) == first);
  folder.write("a", "123");
  CHECK(version_of(path) != first);
  folder.write("b", "1234");
  std::filesystem::rename(folder / "b", path);
  CHECK(version_of(path) != first);
  std::filesystem::remove(path);
  CHECK_FALSE(version_of(path));
}

TEST_CASE("other bytes of the same length are another version, a look and another name are none") {
  const FreshFolder folder;
  const std::string path = folder.write("a", "1234");
  // Older than the resolution of the file system's clock.
  std::filesystem::last_write_time(
      path, std::filesystem::last_write_time(path) - std::chrono::seconds(10));
  const auto first = version_of(path);
  REQUIRE(first);
  CHECK(folder.read("a") == "1234");
  std::filesystem::create_symlink(path, folder / "soft");
  CHECK(version_of(folder / "soft") == first);
  std::filesystem::rename(path, folder / "b");
  CHECK(version_of(folder / "b") == first);
  CHECK_FALSE(version_of(folder / "soft"));
  folder.write("b", "1235");
  CHECK(version_of(folder / "b") != first);
}

TEST_CASE("one file under two names is the same file") {
  const FreshFolder folder;
  const std::string path = folder.write("a", "1");
  std::filesystem::create_hard_link(path, folder / "hard");
  std::filesystem::create_symlink(path, folder / "soft");
  CHECK(same_file(path, folder / "hard"));
  CHECK(same_file(path, folder / "soft"));
  CHECK(same_file(path, folder / "./a"));
  CHECK_FALSE(same_file(path, folder.write("b", "1")));
  CHECK_FALSE(same_file(folder / "absent", folder / "absent"));
}
