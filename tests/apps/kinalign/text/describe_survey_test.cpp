// SPDX-License-Identifier: Apache-2.0
// The text of `kinalign info` about a recording.
#include "apps/kinalign/text/describe_file.h"
#include "tests/check/kinect_survey.h"

#include <doctest/doctest.h>

#include <string>

using namespace kinalign;

namespace {

bool has_line(const RecordingSurvey& survey, const std::string& line) {
  return describe_survey("a.mcap", survey, {}).text.find(line) != std::string::npos;
}

}  // namespace

TEST_CASE("info prints a sender's counts, with its place and its restarts") {
  RecordingSurvey survey = kinect_survey(900, 900, 0);
  CountedSender& sender = survey.senders[0];
  sender.counts.order.restarts = 1;
  CHECK(has_line(survey, "kinect: 900 messages, 0.0 MB; restarted once\n"));
  survey.places = {{"imu/7", "wrist"}};
  sender.stream = "imu";
  sender.node = "7";
  sender.sender = "10.0.0.3:4000";
  CHECK(has_line(survey, "  sender      imu wrist from 10.0.0.3:4000: 900 messages"));
}

TEST_CASE(
    "info marks the counts of a truncated recording, which the recorder writes once a second") {
  RecordingSurvey survey = kinect_survey(314, 336, 0);
  CHECK(has_line(survey, "kinect: 314 messages, 0.0 MB\n"));
  survey.end.reset();
  survey.truncated = {"a.mcap"};
  CHECK(has_line(survey, "/kinect/raw: 336 messages"));
  CHECK(has_line(survey, "kinect: 314 messages, 0.0 MB; counted up to 1 s before the end\n"));
}
