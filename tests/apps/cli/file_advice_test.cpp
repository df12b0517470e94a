// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/file_advice.h"

#include "tests/folder.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

using Lines = std::vector<std::string>;

}  // namespace

TEST_CASE("the advice for a folder names its first recording") {
  const FreshFolder folder;
  const Error error{folder.path(), 0, "any words", "others", ErrorKind::directory};
  CHECK(file_advice(error) == Lines{"name a file in this folder"});
  folder.write("b.mcap", "");
  folder.write("a.mcap", "");
  folder.write("0.csv", "");
  CHECK(file_advice(error) == Lines{"name a file in this folder, such as " + (folder / "a.mcap")});
}

TEST_CASE("for a file that a disk can't read, the call of ddrescue is named") {
  CHECK(file_advice({"t/a.mcap", 0, "any words", "others", ErrorKind::unreadable_disk}) ==
        Lines{"ddrescue t/a.mcap COPY/a.mcap copies all that the disk can read; use the copy, with "
              "copies of all other parts"});
}

TEST_CASE("an error of another kind has no such advice, whatever its words are") {
  CHECK(file_advice({"a.mcap", 0, "a readable file", "Input/output error"}).empty());
  CHECK(file_advice({".", 0, "a regular file", "a directory"}).empty());
}
