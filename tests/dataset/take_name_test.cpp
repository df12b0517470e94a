// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/take_name.h"

#include <doctest/doctest.h>

using namespace kinalign;

TEST_CASE("a take's name and paths are those of BIDS, and read back") {
  const TakeName name{"03", "S2A03", 1};
  CHECK(to_string(name) == "sub-03_task-S2A03_run-01");
  CHECK(path_of(name, TakeFile::take) == "sub-03/sub-03_task-S2A03_run-01_take.h5");
  CHECK(parse_take_name("sub-03_task-S2A03_run-01") == name);
  CHECK(to_string({"a", "b", 123}) == "sub-a_task-b_run-123");
  for (const TakeFile file : {TakeFile::manifest, TakeFile::take, TakeFile::summary}) {
    CHECK(parse_take_path(path_of(name, file)) == std::pair(name, file));
  }
}

TEST_CASE("what is no name of a take is none") {
  for (const char* text :
       {"", "sub-03", "sub-03_task-S2_run-0", "sub-03_task-S2_run-x", "sub-_task-S2_run-01",
        "sub-0-3_task-S2_run-01", "sub-03_task-S2_run-01_x", "sub-03_task-S2_run-99999999999"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_take_name(text));
  }
  for (const char* path : {"sub-03_task-S2_run-01_take.h5", "sub-04/sub-03_task-S2_run-01_take.h5",
                           "sub-03/sub-03_task-S2_run-1_take.h5",
                           "x/sub-03/sub-03_task-S2_run-01_take.h5", "sub-03/notes.txt"}) {
    CAPTURE(path);
    CHECK_FALSE(parse_take_path(path));
  }
}
