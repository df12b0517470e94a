// SPDX-License-Identifier: Apache-2.0
#include "kinalign/protocols/kinect/frames.h"

#include "tests/protocols/kinect/kinect_messages.h"
#include "tests/seeds.h"

#include "kinalign/clock/live/live_clock.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>

using namespace kinalign;

namespace {

struct Joined {
  std::vector<JoinedKinectFrame> frames;
  KinectFrameCounts counts;
};

Joined join(const std::vector<KinectFrame>& messages) {
  KinectFrameJoiner joiner;
  Joined joined;
  for (const auto& message : messages) joiner.take(message, joined.frames);
  joiner.finish(joined.frames);
  joined.counts = joiner.counts();
  return joined;
}

std::vector<std::uint64_t> ids_of(const KinectFrame& frame) {
  std::vector<std::uint64_t> ids;
  for (const auto& body : frame.bodies) ids.push_back(body.id);
  return ids;
}

KinectFrame of_session(std::uint32_t session, std::uint32_t sequence) {
  KinectFrame frame = frame_of(sequence, {1});
  frame.origin.session = session;
  return frame;
}

}  // namespace

TEST_CASE("a divided frame fits the datagrams and is the same joined, in whatever order") {
  for (const auto seed : fresh_seeds(100)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    KinectFrame frame = any_frame(random);
    frame.part = 0;
    frame.more_parts = false;
    auto parts = kinect_parts(frame);
    for (const auto& part : parts) {
      CHECK(encode_kinect_binary(part).size() <= most_kinect_datagram);
      CHECK(part.more_parts == (&part != &parts.back()));
    }
    std::shuffle(parts.begin(), parts.end(), random);
    Joined joined = join(parts);
    REQUIRE(joined.frames.size() == 1);
    CHECK(joined.frames[0].whole);
    auto by_id = [](const KinectBody& a, const KinectBody& b) { return a.id < b.id; };
    auto& bodies = joined.frames[0].frame.bodies;
    std::sort(bodies.begin(), bodies.end(), by_id);
    std::sort(frame.bodies.begin(), frame.bodies.end(), by_id);
    CHECK(encode_kinect_binary(joined.frames[0].frame) == encode_kinect_binary(frame));
  }
}

TEST_CASE("six bodies are two parts, with orientations six") {
  KinectFrame frame = frame_of(1, {1, 2, 3, 4, 5, 6});
  CHECK(kinect_parts(frame).size() == 2);
  CHECK(kinect_parts(frame)[0].bodies.size() == 4);
  frame.has_orientations = true;
  CHECK(kinect_parts(frame).size() == 6);
  CHECK(kinect_parts(frame_of(1, {})).size() == 1);
}

TEST_CASE("a frame that lacks a part comes out as not whole once another one comes") {
  const auto parts = kinect_parts(frame_of(1, {1, 2, 3, 4, 5, 6}));
  const Joined joined = join({parts[1], frame_of(2, {9}), parts[0]});
  REQUIRE(joined.frames.size() == 2);
  CHECK(!joined.frames[0].whole);
  CHECK(ids_of(joined.frames[0].frame) == std::vector<std::uint64_t>{5, 6});
  CHECK(joined.frames[1].whole);
  CHECK(joined.counts.parts_lost == 1);
  CHECK(joined.counts.parts_late == 1);
  CHECK(joined.counts.frames.lost == 0);
}

TEST_CASE("parts that are doubled or of another frame are counted and change nothing") {
  const auto parts = kinect_parts(frame_of(1, {1, 2, 3, 4, 5, 6}));
  KinectFrame foreign = parts[1];
  foreign.device_ticks += 1;
  KinectFrame too_many = parts[1];
  too_many.bodies.resize(3);
  KinectFrame third = parts[1];
  third.part = 2;
  const Joined joined = join({parts[0], parts[0], foreign, too_many, parts[1], parts[1]});
  REQUIRE(joined.frames.size() == 1);
  CHECK(ids_of(joined.frames[0].frame) == std::vector<std::uint64_t>{1, 2, 3, 4, 5, 6});
  CHECK(joined.counts.parts_doubled == 1);
  CHECK(joined.counts.contradicting == 2);
  CHECK(joined.counts.parts_late == 1);  // the last part: its frame was whole
  KinectFrame behind_last = parts[0];    // a part after the one that said it is the last
  behind_last.part = 3;
  const Joined behind = join({third, behind_last});
  CHECK(behind.counts.contradicting == 1);
  CHECK(!behind.frames[0].whole);
  KinectFrame early_end = parts[1];
  early_end.part = 0;
  KinectFrame middle = parts[0];
  middle.part = 1;
  CHECK(join({middle, early_end}).counts.contradicting == 1);
}

TEST_CASE("a joined frame was sent when its first part was, and has hands where a part has") {
  auto parts = kinect_parts(frame_of(1, {1, 2, 3, 4, 5, 6}));
  parts[0].sent_ticks = 500;
  parts[1].sent_ticks = 501;
  parts[1].has_hands = true;
  parts[1].bodies[0].hand_left = 3;
  for (const auto& messages : {std::vector{parts[0], parts[1]}, std::vector{parts[1], parts[0]}}) {
    const Joined joined = join(messages);
    CHECK(joined.frames.at(0).frame.sent_ticks == 500);
    CHECK(joined.frames.at(0).frame.has_hands);
  }
}

TEST_CASE("a frame's own stamp of sending bounds the sender's clock") {
  KinectFrame frame = frame_of(1, {});
  frame.taken_ticks = 1;
  frame.sent_ticks = 2;
  const Exchange exchange = exchange_of(frame, HostTime{Duration{5}});
  CHECK(exchange.boot == 77);
  CHECK(exchange.n_tx.time_since_epoch().count() == 200);
  CHECK(exchange.h_rx.time_since_epoch().count() == 5);
  CHECK(!exchange.echo);
}

TEST_CASE("frames lost, doubled and overtaken are counted by their sequence") {
  const Joined joined = join(
      {frame_of(10, {}), frame_of(13, {}), frame_of(12, {}), frame_of(13, {}), frame_of(14, {})});
  CHECK(joined.frames.size() == 4);
  CHECK(joined.counts.parts_late == 0);
  CHECK(joined.counts.frames.lost == 1);
  CHECK(joined.counts.frames.late == 1);
  CHECK(joined.counts.frames.duplicates == 1);
}

TEST_CASE("a sender that begins anew counts anew, and what comes of the session before is stale") {
  const Joined joined =
      join({of_session(1, 500), of_session(2, 0), of_session(1, 501), of_session(2, 1)});
  CHECK(joined.frames.size() == 3);
  CHECK(joined.counts.sessions == 2);
  CHECK(joined.counts.frames.restarts == 1);
  CHECK(joined.counts.stale == 1);
  CHECK(joined.counts.frames.lost == 0);
  CHECK(joined.counts.frames.received == 3);
}

TEST_CASE("who comes another way goes on with the count, or restarts it by another session") {
  std::vector<JoinedKinectFrame> frames;
  for (const std::uint32_t session : {1U, 2U}) {
    KinectFrameJoiner joiner;
    joiner.follow({{2, 1, 500}, 0, 0});
    joiner.take(of_session(session, 503), frames);
    const bool same = session == 1;
    CHECK(joiner.counts().frames.lost == (same ? 2 : 0));
    CHECK(joiner.counts().frames.restarts == (same ? 0 : 1));
  }
  CHECK(frames.size() == 2);
  CHECK(KinectFrameJoiner().counts().frames.restarts == 0);
}

TEST_CASE("frames that are sent again are duplicates, whoever brings them, and no restart") {
  std::vector<KinectFrame> messages;
  for (std::uint32_t i = 0; i < 350; ++i) messages.push_back(frame_of(i % 300, {1}));
  const Joined joined = join(messages);
  CHECK(joined.frames.size() == 300);
  CHECK(joined.counts.frames == SequenceCounts{350, 0, 0, 50, 0, 0});
  KinectFrameJoiner other;  // a message of a second sender, after the first one's last frame
  other.follow(moment_of(messages[299]));
  std::vector<JoinedKinectFrame> frames;
  for (std::uint32_t i = 0; i < 50; ++i) other.take(frame_of(i, {1}), frames);
  other.finish(frames);
  CHECK(frames.empty());
  CHECK(other.counts().frames == SequenceCounts{51, 0, 0, 50, 0, 0});
}

TEST_CASE(
    "numbers that begin anew with newer ticks are a restart, though the session is the old one") {
  for (const std::uint32_t before : {300U, 100'000U}) {
    CAPTURE(before);
    std::vector<KinectFrame> messages{frame_of(before, {1})};
    for (std::uint32_t i = 0; i < 50; ++i) {
      KinectFrame frame = frame_of(i, {1});
      frame.device_ticks += 100'001 * std::int64_t{333'333};
      messages.push_back(frame);
    }
    const Joined joined = join(messages);
    CHECK(joined.counts.frames.restarts == 1);
    CHECK(joined.frames.size() >= 51 - 15);
  }
}

TEST_CASE("who begins anew on another way with its old session is known by newer ticks there too") {
  for (const std::uint32_t before : {300U, 100'000U}) {
    CAPTURE(before);
    KinectFrameJoiner joiner;
    joiner.follow(moment_of(frame_of(before, {1})));
    std::vector<JoinedKinectFrame> frames;
    for (std::uint32_t i = 0; i < 50; ++i) {
      KinectFrame frame = frame_of(i, {1});
      frame.device_ticks += 100'001 * std::int64_t{333'333};
      joiner.take(frame, frames);
    }
    joiner.finish(frames);
    CHECK(joiner.counts().frames.restarts == 1);
    CHECK(frames.size() >= 50 - 15);
  }
}

TEST_CASE(
    "of two sessions at the same time the newest one's frames are joined, and both are reported") {
  KinectFrameJoiner joiner;
  std::vector<JoinedKinectFrame> frames;
  for (std::uint32_t i = 0; i < 100; ++i) {
    joiner.take(of_session(111, i), frames, "10.0.0.9:1");
    joiner.take(of_session(222, i), frames, "10.0.0.9:1");
  }
  joiner.finish(frames);
  CHECK(frames.size() == 101);
  CHECK(joiner.counts().stale == 99);
  CHECK(joiner.counts().frames.restarts == 1);
  REQUIRE(joiner.overlap());
  CHECK(joiner.overlap()->sessions == std::array<std::uint32_t, 2>{111, 222});
}

TEST_CASE("wild numbers with older ticks make nothing lost, and are dropped") {
  std::vector<KinectFrame> messages;
  for (std::uint32_t i = 0; i < 20; ++i) messages.push_back(frame_of(i, {1}));
  for (std::uint32_t i = 0; i < 40; ++i) {
    messages.push_back(frame_of(2'000'000'000 + i, {1}));
    messages.back().device_ticks = i;
  }
  for (std::uint32_t i = 20; i < 30; ++i) messages.push_back(frame_of(i, {1}));
  const Joined joined = join(messages);
  CHECK(joined.frames.size() == 30);
  CHECK(joined.counts.stale == 40);
  CHECK(joined.counts.frames == SequenceCounts{70, 0, 0, 0, 0, 40});
}

TEST_CASE("sessions for ever: sixteen are remembered, and no more") {
  std::vector<KinectFrame> messages;
  for (std::uint32_t session = 0; session < 1000; ++session) {
    messages.push_back(of_session(session, 0));
  }
  messages.push_back(of_session(983, 1));
  CHECK(join(messages).counts.stale == 1);
  messages.back() = of_session(982, 1);
  CHECK(join(messages).counts.stale == 0);
}

TEST_CASE("a row holds the body that was chosen, stamped by the device's ticks") {
  KinectFrame frame = frame_of(3, {7, 8});
  frame.bodies[1].states[2] = 0;
  frame.bodies[1].states[3] = 1;
  frame.bodies[1].positions[3 * 4] = std::numeric_limits<float>::quiet_NaN();
  PointFrames rows;
  CHECK(append_kinect_row(frame, 8, rows) == 1);
  CHECK(append_kinect_row(frame_of(4, {7}), 8, rows) == 0);
  REQUIRE(rows.size() == 2);
  CHECK(to_ns(rows.stamps[0]) == 100 * (1000 + 3 * 333'333));
  REQUIRE(rows.positions.size() == 2 * 75);
  CHECK(rows.positions[0] == 8.0);
  CHECK(rows.state[0] == Tracking::tracked);
  CHECK(rows.state[2] == Tracking::missing);
  CHECK(rows.positions[3 * 2] == 0.0);
  CHECK(rows.state[3] == Tracking::inferred);
  CHECK(rows.positions[3 * 3] == 8.0);
  CHECK(rows.state[4] == Tracking::missing);  // the joint was not finite
  CHECK(rows.positions[3 * 4 + 1] == 0.0);
  CHECK(std::all_of(rows.state.begin() + 25, rows.state.end(),
                    [](Tracking state) { return state == Tracking::missing; }));
}

TEST_CASE("a ping with its echo is an exchange of the sender's clock") {
  const KinectPing ping{{2, 77, 5}, 123, KinectEcho{4, 9, 100}};
  const HostTime h_rx{std::chrono::seconds(50)}, h_tx{std::chrono::seconds(49)};
  const Exchange exchange = exchange_of(ping, h_rx, h_tx);
  CHECK(exchange.boot == 77);
  CHECK(exchange.n_tx.time_since_epoch().count() == 12'300);
  CHECK(exchange.h_rx == h_rx);
  REQUIRE(exchange.echo);
  CHECK(exchange.echo->n_rx.time_since_epoch().count() == 10'000);
  CHECK(exchange.echo->h_tx == h_tx);
  CHECK(!exchange_of(ping, h_rx, std::nullopt).echo);
  CHECK(!exchange_of(KinectPing{{2, 77, 5}, 123, std::nullopt}, h_rx, h_tx).echo);
}

TEST_CASE("pings give the sender's clock an interval that holds the truth") {
  // The sender's clock is 30 s behind the host's and 20 ppm fast; each way takes 1 to 3 ms.
  for (const auto seed : fresh_seeds(20)) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const auto delay = [&random] {
      return 1'000'000 + static_cast<std::int64_t>(random() % 2'000'000);
    };
    const auto ticks_at = [](std::int64_t host_ns) {
      return static_cast<std::int64_t>(static_cast<double>(host_ns - 30'000'000'000) * 1.00002 /
                                       100.0);
    };
    LiveClock clock;
    std::optional<KinectEcho> echo;
    std::optional<HostTime> h_tx;
    for (std::uint32_t i = 0; i < 100; ++i) {
      const std::int64_t sent = 40'000'000'000 + std::int64_t{i} * 200'000'000;
      const std::int64_t arrived = sent + delay(), answered = arrived + 20'000;
      const KinectPing ping{{2, 77, i}, ticks_at(sent), echo};
      clock.push(exchange_of(ping, HostTime{Duration{arrived}}, h_tx));
      h_tx = HostTime{Duration{answered}};
      echo = {i, 0, ticks_at(answered + delay())};
    }
    const std::int64_t asked = 60'000'000'000;
    const auto stamp = clock.host_from_node(77, kinect_sender_time(ticks_at(asked)));
    REQUIRE(stamp);
    CHECK(stamp->certainty == Certainty::certified);
    REQUIRE(stamp->earliest);
    REQUIRE(stamp->latest);
    CHECK(stamp->earliest->time_since_epoch().count() <= asked);
    CHECK(stamp->latest->time_since_epoch().count() >= asked);
    CHECK(seconds(*stamp->latest - *stamp->earliest) < 0.005);
  }
}
