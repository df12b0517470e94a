// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/simulate/simulate_text.h"

#include <doctest/doctest.h>

using namespace kinalign;
using namespace std::chrono_literals;

namespace {

/// A rehearsal of eight seconds, all sent, accepted and answered, and recorded as in
/// recording.toml.
SentRehearsal well_sent() {
  SentRehearsal sent{.folder = "r", .length_s = 8.0, .sent_s = 8.0, .recorded_there = true};
  sent.counts = {.mocap_frames = 400,
                 .kinect_frames = 240,
                 .node_frames = 600,
                 .node_samples = 4000,
                 .replies = 560,
                 .mocap = {400, 0, 0},
                 .kinect = {290, 0, 40},
                 .nodes = {590, 0, 580},
                 .clicks = {4, 0, 4},
                 .worst_late = 2ms};
  return sent;
}

/// The same rehearsal without a receiver.
SentRehearsal sent_to_nobody() {
  SentRehearsal sent = well_sent();
  LiveCounts& counts = sent.counts;
  for (LiveTraffic* one : {&counts.mocap, &counts.kinect, &counts.nodes, &counts.clicks}) {
    one->refused = one->sent;
    one->received = 0;
  }
  counts.replies = 0;
  sent.recorded_there = false;
  return sent;
}

}  // namespace

TEST_CASE("a rehearsal that was recorded says what was sent, and what comes next") {
  const SentText text = sent_text(well_sent());
  CHECK(text.sent ==
        "  sent 400 frames of mocap, 240 of kinect, 600 of nodes with 4,000 samples\n"
        "  560 replies reached nodes; the latest frame was sent 2.0 ms late\n");
  CHECK(text.no_reply.empty());
  CHECK(text.next == "  next    kinalign align r/recording.toml -o r/take.h5\n");
}

TEST_CASE("a rehearsal that was stopped says when, and no next step as if it were whole") {
  SentRehearsal sent = well_sent();
  sent.sent_s = 1.02;
  const SentText text = sent_text(sent);
  CHECK(text.sent.starts_with("  stopped after 1.0 s of 8.0 s\n"));
  CHECK(text.no_reply.empty());
  CHECK(text.next.empty());
}

TEST_CASE("a rehearsal stopped before any reply has no line about missing replies") {
  SentRehearsal sent = well_sent();
  sent.counts = {.mocap = {1, 0, 0}};
  sent.sent_s = 0.1;
  CHECK(sent_text(sent).no_reply.empty());
}

TEST_CASE("if no port was open, each device and the whole rehearsal say so") {
  const SentText text = sent_text(sent_to_nobody());
  CHECK(text.no_reply ==
        "  datagrams refused by the host: 400 of 400 on mocap port 7012, 290 of 290 on kinect port "
        "7020, 590 of 590 on imu port 5005, 4 of 4 on marks port 7030\n"
        "  the host refused every datagram: is kinalign record running on ports mocap 7012, kinect "
        "7020, imu "
        "5005, "
        "marks 7030 of 127.0.0.1? --begin-in leaves time to start it\n");
  CHECK(text.next.empty());
}

TEST_CASE("another program on a port receives but does not reply") {
  SentRehearsal sent = sent_to_nobody();
  sent.counts.mocap.refused = 0;
  const SentText text = sent_text(sent);
  CHECK(text.no_reply.find("mocap port") == std::string::npos);
  CHECK(text.no_reply.find("\n  no reply came: is kinalign record running on ports mocap 7012, ") !=
        std::string::npos);
  CHECK(sent.unanswered());
  CHECK(text.next.empty());
}

TEST_CASE("refused datagrams are reported if the recorder starts late or has only some ports") {
  SentRehearsal sent = well_sent();
  sent.counts.kinect.refused = 30;
  const SentText text = sent_text(sent);
  CHECK(text.no_reply == "  datagrams refused by the host: 30 of 290 on kinect port 7020\n");
  CHECK(!sent.unanswered());
  CHECK(!text.next.empty());
}

TEST_CASE("a recording of another name is not called by the one that recording.toml has") {
  SentRehearsal sent = well_sent();
  sent.recorded_there = false;
  CHECK(sent_text(sent).next ==
        "  next    r/recording.toml names r/take_01.mcap, which does not exist: replace this name "
        "by the name of your recording\n"
        "          then: kinalign align r/recording.toml -o r/take.h5\n");
}
