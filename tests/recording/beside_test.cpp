// SPDX-License-Identifier: Apache-2.0
#include "kinalign/recording/beside.h"

#include "tests/folder.h"
#include "tests/recording/part_files.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>

using namespace kinalign;

namespace {

std::vector<std::string> sorted(std::vector<std::string> paths) {
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace

TEST_CASE("the number of a part is that of its name") {
  CHECK(part_number("take.part2.mcap") == 2);
  CHECK(part_number("a/b.part17.mcap") == 17);
  for (const char* name : {"take.mcap", "part2.mcap", "take.part.mcap", "take.part2.txt",
                           "take.part99999999999999999999.mcap", ""}) {
    CAPTURE(name);
    CHECK(part_number(name) == 0);
  }
}

TEST_CASE("of links all folders are looked into, in whatever order the files are named") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string a = folder.write("A/a.mcap", part_of(1, 0, 20, false));
  const std::string b = folder.write("B/a.part2.mcap", part_of(2, 20, 40, false));
  const std::string c = folder.write("B/a.part3.mcap", part_of(3, 40, 60, true));
  const std::string link = folder / "A/a.part2.mcap";
  std::filesystem::create_symlink("../B/a.part2.mcap", link);
  for (const auto& named : {std::vector{a}, std::vector{a, b}, std::vector{b, a},
                            std::vector{a, link}, std::vector{link, a}, std::vector{c, a}}) {
    for (const auto& all : {with_parts(files, named), with_namesakes(files, named)}) {
      CHECK(all.size() == 3);
      for (const std::string& one : {a, b, c}) {
        CHECK(std::any_of(all.begin(), all.end(), [&](const std::string& found) {
          return std::filesystem::equivalent(found, one);
        }));
      }
    }
  }
}

TEST_CASE("a file that is of the recording by its name alone is told, also by its first name") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string renamed = folder.write("old.mcap", part_of(1, 0, 20, false));
  CHECK(judge_namesakes(files, renamed).empty());
  const std::string damaged = folder.write("a.part2.mcap", "???");
  const Findings told = judge_namesakes(files, renamed);
  REQUIRE(told.size() == 1);
  CHECK(told.front().what.file == damaged);
  std::filesystem::remove(damaged);
  // A recording of another machine that has the same file name.
  std::string another = part_of(1, 0, 20, true);
  folder.write("a.mcap", another.replace(another.find("lab"), 3, "bal"));
  CHECK(judge_namesakes(files, renamed).empty());
  CHECK(sorted(with_parts(files, {renamed})) == std::vector{renamed});
}

TEST_CASE("of two files that don't say what they are one has the other's name, and is told") {
  const FreshFolder folder;
  PosixFiles files;
  const std::string a = folder.write("a.mcap", mcap_file(6, 3, McapCompression::none));
  CHECK(judge_namesakes(files, a).empty());
  const std::string b = folder.write("a.part2.mcap", mcap_file(6, 3, McapCompression::none));
  const Findings told = judge_namesakes(files, a);
  REQUIRE(told.size() == 1);
  CHECK(told.front().what.file == b);
}

TEST_CASE("a name beside a file, of whatever number, is its recording's") {
  const FreshFolder folder;
  const std::string a = folder.write("a.mcap", "");
  for (const char* name : {"a.mcap", "a.part2.mcap", "a.part77.mcap"}) {
    CHECK(is_namesake(folder / name, a));
  }
  for (const char* name : {"b.mcap", "a.parts.mcap", "sub/a.part2.mcap"}) {
    CHECK_FALSE(is_namesake(folder / name, a));
  }
}
