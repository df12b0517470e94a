// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/text/describe_report.h"

#include "tests/seeds.h"

#include "kinalign/documents/report_json.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <ctime>
#include <random>

using namespace kinalign;

namespace {

using Json = nlohmann::ordered_json;

std::string any_text(std::mt19937_64& random) {
  std::string text;
  for (std::size_t n = random() % 12; n > 0; --n) text += "ab \"\\/.:{}[]"[random() % 12];
  return text;
}

/// A report in which every member of every part is set.
AlignmentReport full_report(std::mt19937_64& random) {
  AlignmentReport report;
  report.frames = 3601;
  report.begin = utc_time(1'700'000'000'123'000'000);
  report.end = utc_time(1'700'000'060'123'400'000);
  report.rate_hz = 60.0;
  report.reference = "mocap";
  StreamReport kinect;
  kinect.stream = "kinect";
  kinect.nodes = {"a"};
  kinect.rate_hz = 29.92;
  kinect.samples = 1000;
  kinect.invalid = 22;
  kinect.gaps = 2;
  kinect.gap_time_ns = 830'000'000;
  kinect.worst_interval_ns = 3'600'000;
  report.streams = {kinect};
  report.spaces = {
      {"kinect", "mocap", "fit", {}, 1.0, 2.362, 0.043, {{"Head", "Head", 5, 1.0, 0.1}}}};
  report.marks = {{report.begin - std::chrono::milliseconds(53), "start", "dance",
                   std::chrono::milliseconds(53), "trigger"}};
  for (std::size_t n = 1 + random() % 5; n > 0; --n) {
    report.findings.push_back({static_cast<Severity>(random() % 3),
                               {any_text(random), static_cast<std::int64_t>(random() % 100),
                                any_text(random), any_text(random)},
                               any_text(random),
                               any_text(random)});
  }
  return report;
}

/// The JSON that `kinalign info take.h5 --json` prints for a take with this report.
Json facts(const AlignmentReport& report) {
  Json out =
      Json::parse(R"({"file": "t.h5", "kind": "take", "software": "kinalign 1", "subject": "S",
      "action": "walk", "frames": 3601, "streams": [{"name": "kinect", "kind": "points",
      "parts": "2 joints", "names": ["Head", "Neck"], "files": [{"name": "k.csv",
      "sha256": "0123456789abcdef", "bytes": 9}]}]})");
  out["report"] = Json::parse(report_json(report));
  return out;
}

std::string calendar(std::time_t s, int ms) {
  std::array<char, 40> room{};
  std::strftime(room.data(), room.size(), "%F %T", std::gmtime(&s));
  return std::string(room.data()) + "." + std::to_string(1000 + ms).substr(1);
}

}  // namespace

TEST_CASE("what alignment found comes back from its report, word for word") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const AlignmentReport report = full_report(random);
    const auto found = report_findings(report_json(report), "t.h5");
    REQUIRE(found);
    CHECK(findings_json(*found) == findings_json(report.findings));
  }
  const auto none = report_findings("{", "t.h5");
  REQUIRE_FALSE(none);
  CHECK(to_string(none.error()) == "t.h5: expected a report as JSON, found text that is not JSON");
}

TEST_CASE("a take's page says its span in UTC, its streams, their losses and their spaces") {
  std::mt19937_64 random(1);
  const std::string text = take_text(facts(full_report(random)).dump(), Names::yes);
  CAPTURE(text);
  const auto has = [&text](const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  CHECK(
      text.starts_with("t.h5: a take by kinalign 1, 3,601 frames at 60 Hz, 1 min 00 s\n"
                       "  subject S, action walk\n"));
  CHECK(has("  mark     start dance at -0.053 s, by trigger\n"));
  CHECK(has("  from " + calendar(1'700'000'000, 123) + " to " + calendar(1'700'000'060, 123) +
            " UTC\n"));
  CHECK(
      has("  kinect   points: 2 joints\n           Head, Neck\n           k.csv  sha256 "
          "0123456789ab...\n"));
  CHECK(has("29.92 Hz, ± 3.6 ms, 97.8 % valid, 2 gaps (0.83 s), nearest sample within "));
  CHECK(has("  space    kinect on mocap, fit: 4.3 cm rms (before: 236.2)\n"));
  CHECK(has("           Head             on Head               10.0 cm over 5 rows\n"));
}

TEST_CASE("stamps from near zero have no date, later ones that of the calendar, rounded to 1 ms") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    AlignmentReport report = full_report(random);
    const auto s = static_cast<std::time_t>(40'000'000 + random() % 4'000'000'000);
    const int ms = static_cast<int>(random() % 1000);
    report.begin =
        utc_time(s * 1'000'000'000 + ms * 1'000'000 + static_cast<int>(random() % 499'000));
    report.end = report.begin;
    CHECK(take_text(facts(report).dump(), Names::no).find("  from " + calendar(s, ms) + " to ") !=
          std::string::npos);
  }
  std::mt19937_64 random(1);
  AlignmentReport report = full_report(random);
  report.begin = utc_time(1'500'000'000);
  report.end = utc_time(61'500'000'000);
  CHECK(take_text(facts(report).dump(), Names::no)
            .find("  from 1.500 to 61.500 s, no date known\n") != std::string::npos);
}

TEST_CASE("a take with wrong types in its report still gets its page") {
  std::mt19937_64 random(1);
  const Json whole = facts(full_report(random)), flat = whole.flatten();
  const std::vector<Json> others{nullptr,      true,           -1,           7,
                                 1e17,         "x\x1b[31m",    "",           Json::array(),
                                 {1, "a", {}}, Json::object(), {{"name", 3}}};
  for (const auto& [path, value] : flat.items()) {
    for (Json::json_pointer at(path); !at.empty(); at.pop_back()) {
      for (const Json& other : others) {
        CAPTURE(at.to_string());
        CAPTURE(other.dump());
        Json changed = whole;
        changed[at] = other;
        const std::string text = take_text(changed.dump(), Names::yes);
        CHECK(text.ends_with('\n'));
        if (changed.contains("report")) CHECK(report_findings(changed["report"].dump(), "t.h5"));
      }
    }
  }
  for (const std::string text : {"", "[]", "3", "null", "{"})
    CHECK(take_text(text, Names::yes).ends_with('\n'));
}
