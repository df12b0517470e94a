// SPDX-License-Identifier: Apache-2.0
#include "kinalign/dataset/export/release.h"

#include <doctest/doctest.h>

using namespace kinalign;

namespace {

Catalogue plain() {
  Catalogue catalogue;
  catalogue.subjects = {{"03", "m", "", "", 175.0, std::nullopt, {}},
                        {"s04", "f", "", "", 175.0, std::nullopt, {}}};
  catalogue.actions = {{"S1A01", "S1", "walking, 10 times"}};
  catalogue.devices = {{"kinect", {{"make", "Microsoft"}, {"model", "Kinect v2"}}}};
  return catalogue;
}

std::vector<Severity> severities(const Catalogue& catalogue) {
  std::vector<Severity> out;
  for (const Finding& one : look_for_people(catalogue, "dataset.toml", {"kinect", "wrist_left"}))
    out.push_back(one.severity);
  return out;
}

}  // namespace

TEST_CASE("release: numbers as ids and names of products identify no person") {
  CHECK(severities(plain()).empty());
}

TEST_CASE("release: names, dates, addresses and serial numbers are errors") {
  const std::vector<Severity> error{Severity::error};
  Catalogue one = plain();
  one.subjects[0].id = "maria";
  CHECK(severities(one) == error);
  for (const char* text : {"on 2024-03-07", "7.3.2024", "write to a.b@lab.edu", "+49 89 1234567",
                           "at 00:1A:7D:DA:71:13"}) {
    CAPTURE(text);
    one = plain();
    one.actions[0].name = text;
    CHECK(severities(one) == error);
  }
  one = plain();
  one.devices[0].texts["serial_number"] = "A22596V01234";
  CHECK(severities(one) == error);
}

TEST_CASE("release: a citation and a licence may have years, pages and numbers, but no address") {
  Catalogue one = plain();
  for (const char* text : {"Walks. Sensors 2016, 16, pp. 2137-2146", "2016, 1010-1019",
                           "ISBN 978-3-16-148410-0", "CC BY 4.0 since 2024-03-07"}) {
    CAPTURE(text);
    one.citation = one.licence = text;
    CHECK(severities(one).empty());
  }
  one.citation = "ask a.b@lab.edu";
  CHECK(severities(one) == std::vector<Severity>{Severity::error});
}

TEST_CASE("release: ids of all tables are looked at") {
  for (const bool is_named : {false, true}) {
    const std::string id = is_named ? "Maria" : "walk20240307";
    for (int table = 0; table < 4; ++table) {
      CAPTURE(table);
      Catalogue one = plain();
      if (table == 0) one.actions[0].id = id;
      if (table == 1) one.classes = {{id, ""}};
      if (table == 2) one.devices[0].id = id;
      if (table == 3) one.rigs = {{id, {}}};
      CHECK(severities(one) ==
            std::vector<Severity>{is_named ? Severity::warning : Severity::error});
    }
  }
  Catalogue one = plain();
  one.actions = {{"slowWalk", "S1", ""}, {"CTK", "S1", ""}};
  CHECK(severities(one).empty());
}

TEST_CASE("release: free text about a person is a warning, a height of one's own a note") {
  Catalogue one = plain();
  one.subjects[0].consent = "released, form 12";
  one.subjects[1].height_cm = 203.0;
  // Then each of the two heights belongs to one person.
  CHECK(severities(one) ==
        std::vector<Severity>{Severity::warning, Severity::note, Severity::note});
}

TEST_CASE("release: names of raw files are hidden wherever they stand") {
  TakeHeader header;
  header.groups = {{"kinect", PointGroup{{"Head"}}, true, true, {{"raw/Maria.csv", "", 1}}}};
  StreamOptions stream;
  stream.name = "kinect";
  stream.files = {{"raw/Maria.csv", ""}};
  stream.select = {{"person", "Maria Huber"}, {"body", "2"}};
  header.parameters.streams = {stream};
  AlignmentReport report;
  report.marks.resize(1);
  report.findings = {
      {Severity::note, Error{"raw/Maria.csv", 3, "a number", "raw/Maria.csv: x"}, "", ""}};
  hide_names(header, report);
  CHECK(header.groups[0].files[0].name == "kinect.csv");
  CHECK(header.parameters.streams[0].files[0].path == "kinect.csv");
  CHECK(header.parameters.streams[0].select ==
        std::map<std::string, std::string>{{"person", ""}, {"body", "2"}});
  CHECK(report.marks.empty());
  CHECK(report.findings[0].what.file == "kinect.csv");
  CHECK(report.findings[0].what.found == "kinect.csv: x");
}

TEST_CASE("release: no stamp of a stream gives away by how much the rows were moved") {
  const std::int64_t day = 1'700'000'000'000'000'000, moved = 946'684'800'000'000'000 - day;
  AlignmentReport report;
  report.begin = utc_time(day);
  report.end = utc_time(day + 60);
  report.streams.resize(2);  // one on the take's clock, one on the device's own
  report.streams[0].survey.first = utc_time(day - 5);
  report.streams[0].survey.last = utc_time(day + 70);
  report.streams[1].survey.last = utc_time(65);
  TakeHeader header;
  header.parameters.streams.resize(3);
  header.parameters.streams[0].start_ns = day - 5;
  header.parameters.streams[0].end_ns = day + 70;
  header.parameters.streams[1].start_ns = 0;
  header.parameters.streams[2].end_ns = day + 70;
  move_dates(Duration{moved}, header, report);
  CHECK(to_ns(report.begin) == day + moved);
  CHECK(to_ns(report.end) == day + 60 + moved);
  CHECK(to_ns(report.streams[0].survey.first) == 0);
  CHECK(to_ns(report.streams[0].survey.last) == 75);
  CHECK(to_ns(report.streams[1].survey.first) == 0);
  CHECK(to_ns(report.streams[1].survey.last) == 65);
  CHECK(header.parameters.streams[0].start_ns == 0);
  CHECK(header.parameters.streams[0].end_ns == 75);
  CHECK(header.parameters.streams[1].start_ns == 0);
  CHECK(header.parameters.streams[2].end_ns == 0);
}

TEST_CASE("release: of two names the longer one is hidden as a whole, with its folder") {
  TakeHeader header;
  header.groups = {{"kinect", PointGroup{}, true, false, {{"a.csv", "", 0}}, "take"},
                   {"imu", ImuGroup{}, true, false, {{"data/a.csv", "", 0}}, "take"}};
  AlignmentReport report;
  report.findings = {
      {Severity::note, Error{"data/a.csv", 0, "rows as in a.csv", "others"}, "", ""}};
  hide_names(header, report);
  CHECK(report.findings[0].what.file == "imu.csv");
  CHECK(report.findings[0].what.expected == "rows as in kinect.csv");
}
