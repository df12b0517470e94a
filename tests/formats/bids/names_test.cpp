// SPDX-License-Identifier: Apache-2.0
#include "kinalign/formats/bids/names.h"

#include "tests/seeds.h"

#include <doctest/doctest.h>

#include <string>

using namespace kinalign;

TEST_CASE("a tracking system's files are called by its entities") {
  const BidsEntities all{"03", "S1A02", "suit", "2"};
  CHECK(bids_path(all, "motion.tsv") ==
        "sub-03/motion/sub-03_task-S1A02_tracksys-suit_run-2_motion.tsv");
  CHECK(bids_scans_path(all) == "sub-03/sub-03_scans.tsv");
  const BidsEntities few{"03", "walk", "kinect", ""};
  CHECK(bids_path(few, "channels.json") ==
        "sub-03/motion/sub-03_task-walk_tracksys-kinect_channels.json");
  CHECK(bids_scans_path(few) == "sub-03/sub-03_scans.tsv");
}

TEST_CASE("names are taken apart into entities and ending") {
  const auto name = parse_bids_name("sub-03_task-walk_tracksys-suit_motion.tsv");
  REQUIRE(name);
  CHECK(name->label("sub") == "03");
  CHECK(name->label("tracksys") == "suit");
  CHECK(name->label("ses") == "");
  CHECK(name->ending == "motion.tsv");
  CHECK(parse_bids_name("motion.json")->entities.empty());
  CHECK(!parse_bids_name("sub-03_walk_motion.tsv"));
  CHECK(!parse_bids_name("sub-_motion.tsv"));
  CHECK(!parse_bids_name("sub-03"));
  CHECK(!parse_bids_name(""));
}

TEST_CASE("times of scans.tsv are written to a microsecond and read again") {
  CHECK(acq_time_text(utc_time(0)) == "1970-01-01T00:00:00.000000Z");
  CHECK(acq_time_text(utc_time(-1)) == "1969-12-31T23:59:59.999999Z");
  CHECK(acq_time_text(utc_time(1'790'000'000'123'456'789)) == "2026-09-21T14:13:20.123456Z");
  for (const std::uint64_t seed : fresh_seeds(300)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const Time time = utc_time(static_cast<std::int64_t>(random() % 3'700'000'000'000'000) * 1000);
    CHECK(parse_acq_time(acq_time_text(time)) == time);
  }
  CHECK(parse_acq_time("1970-01-01T00:00:01") == utc_time(1'000'000'000));
  CHECK(parse_acq_time("1970-01-01T00:00:00.25Z") == utc_time(250'000'000));
}

TEST_CASE("what is no time is none; a year before 1850 is one that can't be a stamp") {
  for (const char* none : {"", "now", "1970-01-01 00:00:00", "1970-13-01T00:00:00",
                           "1970-02-30T00:00:00", "1970-01-01T24:00:00", "1970-01-01T00:00:00.",
                           "1970-01-01T00:00:00.x", "1970-01-01T00:00", "70-01-01T00:00:00"}) {
    CAPTURE(none);
    CHECK(!is_acq_time(none));
    CHECK(!parse_acq_time(none));
  }
  CHECK(is_acq_time("1800-12-31T05:05:05.022"));
  CHECK(!parse_acq_time("1800-12-31T05:05:05.022"));
}
