// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/import/ids.h"

#include "kinalign/dataset/take_name.h"

#include <doctest/doctest.h>

using namespace kinalign;

TEST_CASE("an id has the word's letters and digits") {
  CHECK(label_of("walk") == "walk");
  CHECK(label_of("slow walk_2") == "slowWalk2");
  CHECK(label_of("_walk-") == "walk");
  CHECK(label_of("../../etc") == "etc");
  CHECK(label_of("") == "x");
  CHECK(label_of("...") == "x");
  CHECK(is_label(label_of(std::string(1000, 'a'))));
}

TEST_CASE("two words never get one id, and a word always gets the same one") {
  Ids ids({});
  CHECK(ids.of("slow walk") == "slowWalk");
  CHECK(ids.of("slow_walk") == "slowWalkx2");
  // Some file systems do not tell capital from small letters.
  CHECK(ids.of("SLOWWALK") == "SLOWWALKx3");
  CHECK(ids.of("slow walk") == "slowWalk");
  CHECK(ids.changed().size() == 3);
}

TEST_CASE("an action that is there is known again by its id or by its name") {
  Ids ids({{"m01", "deep squat"}, {"slowWalk", "slow_walk"}, {"slowWalkx2", "slow walk"}});
  CHECK(ids.of("m01") == "m01");
  CHECK(ids.of("slow walk") == "slowWalkx2");
  CHECK(ids.of("slow_walk") == "slowWalk");
  CHECK(ids.of("slow.walk") == "slowWalkx3");
}
