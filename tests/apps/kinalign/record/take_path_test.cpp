// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record/take_path.h"

#include "tests/folder.h"

#include <doctest/doctest.h>

using namespace kinalign;

TEST_CASE("a take's name says who and what, and has the next number that is free") {
  const FreshFolder folder;
  CHECK(free_take_path(folder.path(), "03", "S1A02") == folder / "03_S1A02_01.mcap");
  CHECK(free_take_path(folder.path(), "a b/c", "") == folder / "a-b-c_01.mcap");
  folder.write("take_01.mcap", "");
  CHECK(free_take_path(folder.path(), "", "") == folder / "take_02.mcap");
}

TEST_CASE("a name is not free while a part of another recording has it") {
  const FreshFolder folder;
  folder.write("take_01.part2.mcap", "");
  folder.write("take_02.part17.mcap", "");
  folder.write("take_03.part2.txt", "");
  CHECK(free_take_path(folder.path(), "", "") == folder / "take_03.mcap");
  CHECK(free_take_path(folder / "not there", "", "") == folder / "not there/take_01.mcap");
}
