// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/text/describe_file.h"
#include "tests/folder.h"
#include "tests/formats/xdf/xdf_cases.h"

#include <nlohmann/json.hpp>

using namespace kinalign;
using Json = nlohmann::json;

namespace {

XdfSurvey surveyed(const std::string& bytes) {
  const FreshFolder folder;
  PosixFiles files;
  const auto survey = survey_xdf(files, folder.write("rec.xdf", bytes), {});
  REQUIRE(survey);
  return *survey;
}

/// Two channels at 4 Hz with a clock, and markers that were never sent.
std::string two_streams() {
  const std::string about =
      "<type>EEG</type><hostname>lab</hostname><desc><channels><channel><label>Fp1</label>"
      "<unit>uV</unit></channel><channel><label>Fp2</label></channel></channels></desc>";
  std::string bytes = xdf_begin + xdf_header(7, "double64", 2, "4", about) +
                      xdf_header(8, "string", 1) + xdf_offset(7, 5.0, -0.125);
  for (int k = 0; k < 1200; ++k) {
    const std::string values = little_text(1.0 * k) + little_text(0.5);
    bytes += xdf_samples(7, 1, k % 2 == 0 ? xdf_sample(5.0 + k / 4.0, values) : xdf_sample(values));
  }
  return bytes;
}

}  // namespace

TEST_CASE("info prints an XDF's streams: kind, samples, stamps and clocks") {
  const XdfSurvey survey = surveyed(two_streams());
  CHECK(describe_survey("rec.xdf", survey, Names::no).text ==
        "rec.xdf\n"
        "  format      XDF 1.0\n"
        "  size        0.0 MB\n"
        "  stream      N7 (EEG): 2 channels of double64, 1,200 samples, 4 Hz nominal, 4 Hz by the "
        "stamps\n"
        "    stamps    5.000000 to 304.750000 s, 299.8 s of the sender's clock; 600 deduced by the "
        "rate\n"
        "    clock     1 clock offset: -0.125000 s, +0.000 ppm, residuals up to 0.000 ms\n"
        "  stream      N8: 1 channel of string, 0 samples, irregular\n"
        "    clock     no clock offsets\n");
  CHECK(describe_survey("rec.xdf", survey, Names::yes)
            .text.find("    channel   Fp1, uV\n    channel   Fp2\n") != std::string::npos);
}

TEST_CASE("info --json has an XDF's streams with their whole headers") {
  const Json json =
      Json::parse(describe_survey("rec.xdf", surveyed(two_streams()), Names::no).json);
  REQUIRE(json["streams"].size() == 2);
  const Json& one = json["streams"][0];
  CHECK(one["id"] == 7);
  CHECK(one["name"] == "N7");
  CHECK(one["type"] == "EEG");
  CHECK(one["hostname"] == "lab");
  CHECK(one["channel_format"] == "double64");
  CHECK(one["channel_count"] == 2);
  CHECK(one["channels"][0] == Json{{"label", "Fp1"}, {"unit", "uV"}, {"type", ""}});
  CHECK(one["nominal_rate_hz"] == 4.0);
  CHECK(one["samples"] == 1200);
  CHECK(one["deduced_stamps"] == 600);
  CHECK(one["first_s"] == 5.0);
  CHECK(one["last_s"] == 304.75);
  CHECK(one["clock_offsets"] == 1);
  CHECK(one["clock"][0]["offset_s"] == -0.125);
  CHECK(json["streams"][1]["first_s"].is_null());
}
