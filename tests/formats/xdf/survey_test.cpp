// SPDX-License-Identifier: Apache-2.0
#include "tests/folder.h"
#include "tests/formats/xdf/xdf_cases.h"

#include <cmath>

using namespace kinalign;

namespace {

XdfSurvey surveyed(const std::string& bytes) {
  const FreshFolder folder;
  PosixFiles files;
  const std::string path = folder.write("rec.xdf", bytes);
  CHECK(looks_like_xdf(bytes));
  const auto survey = survey_xdf(files, path, {});
  REQUIRE(survey);
  CHECK(survey->bytes == bytes.size());
  return *survey;
}

std::string value(double x) { return little_text(x); }

}  // namespace

TEST_CASE("an XDF's streams are surveyed: samples, stamps, deduced ones, rate") {
  const XdfSurvey survey = surveyed(
      xdf_begin + xdf_header(7, "double64", 1, "4") + xdf_header(3, "string", 1) +
      xdf_samples(7, 3,
                  xdf_sample(5.5, value(1)) + xdf_sample(value(2)) + xdf_sample(6.0, value(3))) +
      xdf_samples(7, 1, xdf_sample(7.5, value(4))));
  CHECK(survey.findings.empty());
  REQUIRE(survey.streams.size() == 2);
  const XdfStreamSurvey& one = survey.streams[0];
  CHECK(one.stream.id == 7);
  CHECK(one.samples == 4);
  CHECK(one.deduced == 1);
  CHECK(one.first == 5.5);
  CHECK(one.last == 7.5);
  CHECK(one.rate_hz() == 1.5);
  CHECK(one.backward == 0);
  CHECK(one.no_numbers == 0);
  const XdfStreamSurvey& silent = survey.streams[1];
  CHECK(silent.samples == 0);
  CHECK(!silent.first);
  CHECK(silent.rate_hz() == 0.0);
}

TEST_CASE("of an XDF's stream it is counted what is no number, no time or goes back") {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const XdfSurvey survey = surveyed(
      xdf_begin + xdf_header(1, "double64", 2) +
      xdf_samples(1, 4,
                  xdf_sample(10.0, value(std::nan("")) + value(-infinity)) +
                      xdf_sample(8.75, value(1) + value(2)) + xdf_sample(9.5, value(3) + value(4)) +
                      xdf_sample(std::nan(""), value(5) + value(6))));
  const XdfStreamSurvey& one = survey.streams.at(0);
  CHECK(one.no_numbers == 2);
  CHECK(one.backward == 1);
  CHECK(one.largest_step_back_s == 1.25);
  CHECK(one.timeless == 1);
  CHECK(one.first == 8.75);
  CHECK(one.last == 10.0);
}

TEST_CASE("an XDF's clock offsets go to their stream, a line for each run of its clock") {
  std::string bytes = xdf_begin + xdf_header(1, "int16", 1) + xdf_header(2, "int16", 1);
  for (int k = 0; k < 20; ++k) bytes += xdf_offset(1, 5.0 * k, 0.25);
  for (int k = 0; k < 20; ++k) bytes += xdf_offset(1, 5.0 * k, 40.0);  // the clock began anew
  const XdfSurvey survey = surveyed(bytes);
  CHECK(survey.streams.at(0).clock_offsets == 40);
  REQUIRE(survey.streams[0].clock.size() == 2);
  CHECK(survey.streams[0].clock[1].offset == doctest::Approx(40.0).epsilon(1e-9));
  CHECK(survey.streams.at(1).clock_offsets == 0);
}

TEST_CASE("an XDF that breaks off is surveyed up to there, and that is said") {
  const std::string whole = xdf_begin + xdf_header(1, "double64", 1) +
                            xdf_samples(1, 1, xdf_sample(1.0, value(1))) +
                            xdf_samples(1, 1, xdf_sample(2.0, value(2)));
  const XdfSurvey survey = surveyed(whole.substr(0, whole.size() - 3));
  CHECK(survey.streams.at(0).samples == 1);
  REQUIRE(survey.findings.size() == 1);
  CHECK(survey.findings[0].what.expected == "a last chunk of 25 bytes");
}
