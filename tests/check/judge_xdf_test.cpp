// SPDX-License-Identifier: Apache-2.0
#include "tests/folder.h"
#include "tests/formats/xdf/xdf_cases.h"

#include "kinalign/check/judge_survey.h"

#include <cmath>
#include <limits>

using namespace kinalign;

namespace {

std::vector<std::string> judged(const std::string& bytes) {
  const FreshFolder folder;
  PosixFiles files;
  const auto survey = survey_xdf(files, folder.write("rec.xdf", bytes), {});
  REQUIRE(survey);
  std::vector<std::string> out;
  for (const Finding& f : judge_survey("rec.xdf", *survey)) {
    out.push_back(std::string(to_string(f.severity)) + ": " + f.what.expected + "; " +
                  f.what.found);
  }
  return out;
}

}  // namespace

TEST_CASE("check reports the faults of an XDF, and nothing for a sound file") {
  const std::string sound = xdf_begin + xdf_header(1, "double64", 1) + xdf_offset(1, 1.0, 0.5) +
                            xdf_samples(1, 1, xdf_sample(1.0, little_text(2.5)));
  CHECK(judged(sound).empty());
  const std::string more = xdf_samples(1, 1, xdf_sample(0.25, little_text(std::nan(""))));
  CHECK(judged(sound + more) ==
        std::vector<std::string>{
            "warning: rising stamps of stream 'N1'; 1 that step back, by up to 0.750 s",
            "note: finite values of stream 'N1'; 1 NaN or infinite values"});
  CHECK(judged(sound + more.substr(0, 20)).front() ==
        "warning: a last chunk of 25 bytes; 15 bytes at byte " + std::to_string(sound.size()));
  CHECK(judged(sound + xdf_header(8, "string", 1)) ==
        std::vector<std::string>{"note: samples of stream 'N8'; none"});
  const double nowhere = std::numeric_limits<double>::infinity();
  CHECK(judged(xdf_begin + xdf_header(1, "double64", 1) +
               xdf_samples(1, 1, xdf_sample(nowhere, little_text(1.0)))) ==
        std::vector<std::string>{"warning: stamps below 1e15 of stream 'N1'; 1 other stamps",
                                 "note: clock offsets of stream 'N1'; none"});
  CHECK(judged(xdf_begin) == std::vector<std::string>{"warning: a readable stream; none"});
  std::string resets = sound;
  for (const double offset : {0.5, 0.5, 90.0, 90.0}) resets += xdf_offset(1, 9.0, offset);
  CHECK(judged(resets) == std::vector<std::string>{"warning: one clock of stream 'N1'; 2 clocks"});
}
