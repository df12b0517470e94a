// SPDX-License-Identifier: Apache-2.0
// The text of `kinalign check` about a recording's survey.
#include "apps/kinalign/text/describe_file.h"

#include <doctest/doctest.h>

#include <string>

using namespace kinalign;

namespace {

/// A whole recording of one Kinect.
RecordingSurvey kinect_survey(std::uint64_t counted, std::uint64_t present, std::uint64_t missing) {
  RecordingSurvey survey;
  survey.facts.emplace();
  survey.facts->part = 1;
  survey.end = RecordingEnd{};
  survey.ending = Ending::ended;
  ChannelSurvey channel;
  channel.channel.topic = "/kinect/raw";
  channel.messages = present;
  channel.missing = missing;
  survey.channels.push_back(channel);
  CountedSender sender;
  sender.topic = "/kinect/raw";
  sender.stream = "kinect";
  sender.counts.messages = counted;
  survey.senders.push_back(sender);
  return survey;
}

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
        "/kinect/raw without a number left out: 7 missing\n");
  CHECK(judged(kinect_survey(1000, 990, 7)) ==
        "/kinect/raw without a number left out: 7 missing\n"
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

TEST_CASE("losses are told of the frames where they are counted, else of the messages") {
  RecordingSurvey survey = kinect_survey(900, 900, 0);
  survey.senders[0].counts.frames = 300;  // each frame is three messages
  survey.senders[0].counts.order.lost = 3;
  CHECK(judged(survey) == "every frame that kinect sent: 3 lost of 303\n");
  survey.senders[0].counts.frames = 0;
  CHECK(judged(survey) == "every frame that kinect sent: 3 lost of 903\n");
}

TEST_CASE("a device that was started anew within a take is told of") {
  RecordingSurvey survey = kinect_survey(900, 900, 0);
  survey.senders[0].counts.order.restarts = 1;
  CHECK(judged(survey) == "one life of kinect: 2: it was started anew\n");
  const std::string text = describe_survey("a.mcap", survey, {}).text;
  CHECK(text.find("kinect: 900 messages, 0.0 MB; started anew once\n") != std::string::npos);
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
        "marks alone at the port of marks: 2 datagrams that are none\n"
        "everything that came to the port of trigger: 3 dropped by the kernel\n"
        "everything that came to the port of kinect: 4 refused, not recorded\n"
        "frames alone of the lab's nodes at the port of imu: 118 that are refused\n"
        "frames of nodes alone at the port of imu: 9 datagrams that are none\n");
  for (const Finding& finding : judge_survey("a.mcap", survey)) {
    const bool harmless = finding.what.expected.find(" alone ") != std::string::npos;
    CHECK(finding.severity == (harmless ? Severity::note : Severity::warning));
  }
}

TEST_CASE("what came to the nodes' port and is no node's is a warning, unless it is a stray one") {
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
        "messages of imu 7: none: 419 datagrams came to its port, none a frame of nodes\n"
        "frames of nodes alone at the port of imu: 419 datagrams that are none\n");
  CHECK(judge_survey("a.mcap", survey).back().severity == Severity::warning);
  // The datagrams that were thrown away may be among its 400 lost frames.
  survey.senders[0].stream = "imu";
  survey.senders[0].counts.order.lost = 400;
  CHECK(judge_survey("a.mcap", survey).back().what.found == "at least 19 datagrams that are none");
  survey.senders[0].counts.order.lost = 419;
  CHECK(judge_survey("a.mcap", survey).back().what.expected.find("alone") == std::string::npos);
}

TEST_CASE("of trackers' datagrams it is told where all were refused, older counts too") {
  RecordingSurvey survey = kinect_survey(79, 79, 0);
  survey.channels[0].channel.message_encoding = "slimevr";
  CHECK(judged(survey).empty());  // written by a version that did not count the frames of trackers
  SenderCounts& counts = survey.senders[0].counts;
  counts.refused = 79;
  CHECK(judged(survey).starts_with("frames of slimevr in what kinect"));
  counts.frames = 79;  // trackers that never shook hands
  CHECK(judged(survey).empty());
}

TEST_CASE("a stream of which no rows can be made is told") {
  RecordingSurvey survey = kinect_survey(1000, 1000, 0);
  survey.channels[0].channel.message_encoding = "kinect";
  survey.senders[0].sender = "10.0.0.3:7012";
  CHECK(judged(survey) ==
        "frames of kinect in what kinect from 10.0.0.3:7012 sent: 1,000 messages, none of them "
        "one\n");
  survey.senders[0].counts.frames = 1000;
  CHECK(judged(survey).empty());
  survey.channels[0].channel.message_encoding = "noitom";
  CHECK(judged(survey) == "a skeleton for kinect: none\n");
  survey.attachments = {"kinect.bvh"};
  CHECK(judged(survey).empty());
}

TEST_CASE("a Kinect's frames that were sent again, or too late, are frames of a Kinect") {
  RecordingSurvey survey = kinect_survey(50, 50, 0);
  survey.channels[0].channel.message_encoding = "kinect";
  CHECK(judged(survey).find("none of them one") != std::string::npos);
  survey.senders[0].counts.order.duplicates = 50;
  CHECK(judged(survey).empty());
  survey.senders[0].counts.order = {};
  survey.senders[0].counts.order.late = 50;
  CHECK(judged(survey).empty());
}

TEST_CASE("a node is told by its place, where the lab says one, else by its id") {
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
  const std::string text = describe_survey("a.mcap", survey, {}).text;
  CHECK(text.find("  sender      imu wrist from 10.0.0.3:4000: 1 messages") != std::string::npos);
  survey.places.clear();
  CHECK(judged(survey) == "every frame that imu 7 from 10.0.0.3:4000 sent: 3 lost of 4\n");
}

TEST_CASE("a later part by itself, which counts from the recording's beginning, lacks nothing") {
  RecordingSurvey part = kinect_survey(1000, 10, 0);
  part.facts->part = 2;
  CHECK(judged(part).empty());
}

TEST_CASE("the counts of a torn recording, which are told once a second, are told as such") {
  RecordingSurvey survey = kinect_survey(314, 336, 0);
  const auto has = [&survey](const std::string& line) {
    return describe_survey("a.mcap", survey, {}).text.find(line) != std::string::npos;
  };
  CHECK(has("kinect: 314 messages, 0.0 MB\n"));
  survey.end.reset();
  survey.truncated = {"a.mcap"};
  CHECK(has("/kinect/raw: 336 messages"));
  CHECK(has("kinect: 314 messages, 0.0 MB; counted up to 1 s before the end\n"));
}

TEST_CASE("of a suit whose frames can mostly not be read check says so") {
  RecordingSurvey survey = kinect_survey(800, 800, 0);
  survey.channels[0].channel.message_encoding = "noitom";
  survey.attachments.emplace_back("kinect.bvh");
  survey.senders[0].counts.frames = 134;
  survey.senders[0].counts.refused = 134;
  CHECK(judged(survey).empty());
  survey.senders[0].counts.refused = 266;
  CHECK(judged(survey) == "frames that can be read in what kinect sent: 134; 266 times none\n");
}

TEST_CASE("check of a torn file proposes a name for the whole one that is not its own") {
  for (const auto& [torn, named] :
       {std::pair("take.mcap", "whole.mcap"), std::pair("whole.mcap", "recovered.mcap")}) {
    RecordingSurvey survey = kinect_survey(1000, 1000, 0);
    survey.messages = 1000;
    survey.truncated = {torn};
    survey.ending = Ending::truncated;
    const Findings told = judge_survey(torn, survey);
    REQUIRE(told.size() == 1);
    CHECK(told.front().repair ==
          std::string("kinalign recover ") + torn + " -o " + named + " gives it one");
  }
}
