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

TEST_CASE("release: numbers as ids and names of products give nobody away") {
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

TEST_CASE("release: free text about a person is a warning, a height of one's own a note") {
  Catalogue one = plain();
  one.subjects[0].consent = "released, form 12";
  one.subjects[1].height_cm = 203.0;
  // Then each of the two heights is one person's.
  CHECK(severities(one) ==
        std::vector<Severity>{Severity::warning, Severity::note, Severity::note});
}

TEST_CASE("release: names of raw files are hidden wherever they stand") {
  TakeHeader header;
  header.groups = {{"kinect", PointGroup{{"Head"}}, true, true, {{"raw/Maria.csv", "", 1}}}};
  StreamOptions stream;
  stream.name = "kinect";
  stream.files = {{"raw/Maria.csv", ""}};
  header.parameters.streams = {stream};
  AlignmentReport report;
  report.marks.resize(1);
  report.findings = {
      {Severity::note, Error{"raw/Maria.csv", 3, "a number", "raw/Maria.csv: x"}, "", ""}};
  hide_names(header, report);
  CHECK(header.groups[0].files[0].name == "kinect.csv");
  CHECK(header.parameters.streams[0].files[0].path == "kinect.csv");
  CHECK(report.marks.empty());
  CHECK(report.findings[0].what.file == "kinect.csv");
  CHECK(report.findings[0].what.found == "kinect.csv: x");
}
