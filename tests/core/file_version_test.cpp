// SPDX-License-Identifier: Apache-2.0
#include "kinalign/core/file_version.h"

#include "tests/folder.h"

#include <doctest/doctest.h>

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
