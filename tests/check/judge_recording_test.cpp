// SPDX-License-Identifier: Apache-2.0
#include "tests/check/kinect_survey.h"

#include "kinalign/check/judge_survey.h"

#include <doctest/doctest.h>

#include <string>

using namespace kinalign;

namespace {

std::string judged(const RecordingSurvey& survey) {
  std::string all;
  for (const Finding& finding : judge_survey("a.mcap", survey)) {
    all += finding.what.expected + ": " + finding.what.found + "\n";
  }
  return all;
}

}  // namespace

TEST_CASE("what the recorder counted and the file lacks is found, at its ends too") {
  CHECK(judged(kinect_survey(1000, 1000, 0)).empty());
  CHECK(judged(kinect_survey(1000, 1010, 0)).empty());  // ten messages came after the last count
  CHECK(judged(kinect_survey(1000, 993, 0)) ==
        "the 1,000 messages on /kinect/raw that were counted: 7 missing\n");
  CHECK(judged(kinect_survey(1000, 993, 7)) ==
        "/kinect/raw with consecutive message numbers: 7 missing\n");
  CHECK(judged(kinect_survey(1000, 990, 7)) ==
        "/kinect/raw with consecutive message numbers: 7 missing\n"
        "the 1,000 messages on /kinect/raw that were counted: 3 missing\n");
}

TEST_CASE("a topic that has nothing at all is missed, several of one name are one") {
  RecordingSurvey none = kinect_survey(5, 0, 0);
  none.channels.clear();
  CHECK(judged(none) == "the 5 messages on /kinect/raw that were counted: 5 missing\n");
  RecordingSurvey two = kinect_survey(10, 6, 0);
  two.channels.push_back(two.channels.front());
  CHECK(judged(two).empty());
}

TEST_CASE("losses are a share of the frames if these are counted, else of the messages") {
  RecordingSurvey survey = kinect_survey(900, 900, 0);
  survey.senders[0].counts.frames = 300;  // each frame is three messages
  survey.senders[0].counts.order.lost = 3;
  CHECK(judged(survey) == "every frame that kinect sent: 3 lost of 303\n");
  survey.senders[0].counts.frames = 0;
  CHECK(judged(survey) == "every frame that kinect sent: 3 lost of 903\n");
}

TEST_CASE("what is no mark blames no machine, and a refused node is no silence") {
  RecordingSurvey survey = kinect_survey(900, 900, 0);
  const auto port = [](const char* name, std::uint64_t refused, std::uint64_t dropped) {
    CountedPort one{name, {}};
    one.counts.refused = refused;
    one.counts.dropped = dropped;
    return one;
  };
  survey.ports = {port("marks", 2, 0), port("trigger", 0, 3), port("kinect", 4, 0),
                  port("imu", 118, 9)};
  survey.ports.back().counts.sifted = true;
  CHECK(judged(survey) ==
        "only marks at the port of marks: 2 datagrams that are not marks\n"
        "all data that arrived at the port of trigger: 3 dropped by the kernel\n"
        "all data that arrived at the port of kinect: 4 refused, not recorded\n"
        "only frames of the lab's nodes at the port of imu: 118 refused datagrams\n"
        "only frames of nodes at the port of imu: 9 other datagrams\n");
  for (const Finding& finding : judge_survey("a.mcap", survey)) {
    const bool harmless = finding.what.expected.starts_with("only ");
    CHECK(finding.severity == (harmless ? Severity::note : Severity::warning));
  }
}

TEST_CASE("many foreign datagrams at the nodes' port are a warning, a few are a note") {
  RecordingSurvey survey = kinect_survey(900, 900, 0);
  survey.expected = {{"imu/7", true}};
  survey.ports = {{"imu", {}}};
  PortCounts& counts = survey.ports.front().counts;
  counts.sifted = true;
  CHECK(judged(survey) == "messages of imu 7: none\n");
  counts.dropped = 19;
  CHECK(judge_survey("a.mcap", survey).back().severity == Severity::note);
  counts.dropped = 419;
  CHECK(judged(survey) ==
        "messages of imu 7: none: 419 datagrams came to its port, none of them a frame of "
        "nodes\nonly frames of nodes at the port of imu: 419 other datagrams\n");
  CHECK(judge_survey("a.mcap", survey).back().severity == Severity::warning);
  // The datagrams that were thrown away may be among its 400 lost frames.
  survey.senders[0].stream = "imu";
  survey.senders[0].counts.order.lost = 400;
  CHECK(judge_survey("a.mcap", survey).back().what.found == "at least 19 other datagrams");
  survey.senders[0].counts.order.lost = 419;
  CHECK(judge_survey("a.mcap", survey).back().what.expected.find("alone") == std::string::npos);
}

TEST_CASE("trackers' datagrams of which all were refused are a warning, also with older counts") {
  RecordingSurvey survey = kinect_survey(79, 79, 0);
  survey.channels[0].channel.message_encoding = "slimevr";
  CHECK(judged(survey).empty());  // written by a version that did not count the frames of trackers
  SenderCounts& counts = survey.senders[0].counts;
  counts.refused = 79;
  CHECK(judged(survey).starts_with("frames of slimevr from kinect"));
  counts.frames = 79;  // trackers that never shook hands
  CHECK(judged(survey).empty());
}

TEST_CASE("a stream that can not become rows is found") {
  RecordingSurvey survey = kinect_survey(1000, 1000, 0);
  survey.channels[0].channel.message_encoding = "kinect";
  survey.senders[0].sender = "10.0.0.3:7012";
  CHECK(judged(survey) ==
        "frames of kinect from kinect from 10.0.0.3:7012: 1,000 messages without such a "
        "frame\n");
  survey.senders[0].counts.frames = 1000;
  CHECK(judged(survey).empty());
  survey.channels[0].channel.message_encoding = "noitom";
  CHECK(judged(survey) == "a skeleton for kinect: none\n");
  survey.attachments = {"kinect.bvh"};
  CHECK(judged(survey).empty());
}

TEST_CASE("a suit without a frame may send its frames in several datagrams") {
  RecordingSurvey survey = kinect_survey(1000, 1000, 0);
  survey.channels[0].channel.message_encoding = "noitom";
  CHECK(judge_survey("a.mcap", survey).at(0).repair ==
        "check the port and the protocol that the device sends to; if its frames arrive in several "
        "datagrams, use TCP");
}

TEST_CASE("a Kinect's frames that were sent again, or too late, are frames of a Kinect") {
  RecordingSurvey survey = kinect_survey(50, 50, 0);
  survey.channels[0].channel.message_encoding = "kinect";
  CHECK(judged(survey).find("without such a frame") != std::string::npos);
  survey.senders[0].counts.order.duplicates = 50;
  CHECK(judged(survey).empty());
  survey.senders[0].counts.order = {};
  survey.senders[0].counts.order.late = 50;
  CHECK(judged(survey).empty());
}

TEST_CASE("a later part by itself, which counts from the recording's beginning, lacks nothing") {
  RecordingSurvey part = kinect_survey(1000, 10, 0);
  part.facts->part = 2;
  CHECK(judged(part).empty());
}

TEST_CASE("a suit whose frames can mostly not be read is a warning") {
  RecordingSurvey survey = kinect_survey(800, 800, 0);
  survey.channels[0].channel.message_encoding = "noitom";
  survey.attachments.emplace_back("kinect.bvh");
  survey.senders[0].counts.frames = 134;
  survey.senders[0].counts.refused = 134;
  CHECK(judged(survey).empty());
  survey.senders[0].counts.refused = 266;
  CHECK(judged(survey) == "readable frames from kinect: 134 readable, 266 not\n");
}

TEST_CASE("check of a truncated file proposes a name for the whole one that is not its own") {
  for (const auto& [truncated, named] :
       {std::pair("take.mcap", "whole.mcap"), std::pair("whole.mcap", "recovered.mcap")}) {
    RecordingSurvey survey = kinect_survey(1000, 1000, 0);
    survey.messages = 1000;
    survey.truncated = {truncated};
    survey.ending = Ending::truncated;
    const Findings found = judge_survey(truncated, survey);
    REQUIRE(found.size() == 1);
    CHECK(found.front().repair ==
          std::string("kinalign recover ") + truncated + " -o " + named + " makes a complete file");
  }
}

TEST_CASE("a device that restarted within a take is a note") {
  RecordingSurvey survey = kinect_survey(900, 900, 0);
  survey.senders[0].counts.order.restarts = 1;
  CHECK(judged(survey) == "one run of kinect: 2 runs: it restarted\n");
}

TEST_CASE("a node is called by its place if the lab names it, else by its id") {
  RecordingSurvey survey = kinect_survey(1, 1, 0);
  survey.expected = {{"imu/3", true}, {"imu/7", true}, {"mocap", true}};
  survey.places = {{"imu/7", "wrist"}};
  CHECK(judged(survey) ==
        "messages of imu 3: none\nmessages of imu wrist: none\nmessages of mocap: none\n");
  survey.expected.clear();
  CountedSender& sender = survey.senders[0];
  sender.stream = "imu";
  sender.node = "7";
  sender.sender = "10.0.0.3:4000";
  sender.counts.order.lost = 3;
  CHECK(judged(survey) == "every frame that imu wrist from 10.0.0.3:4000 sent: 3 lost of 4\n");
  survey.places.clear();
  CHECK(judged(survey) == "every frame that imu 7 from 10.0.0.3:4000 sent: 3 lost of 4\n");
}
