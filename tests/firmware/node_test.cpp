// SPDX-License-Identifier: Apache-2.0
// The frames that a node sends, and their times.
#include "tests/firmware/bench.h"

using namespace kinalign;

TEST_CASE("sampling asks for the counter and the sensor alone") {
  Bench bench;
  bench.board.calls.clear();
  bench.node.tick(1);
  CHECK(bench.board.calls == "ci");
}

TEST_CASE("frames continue at their rate without answers") {
  Bench bench;
  bench.run(10'000'000);
  CHECK(bench.board.sent.size() == 100);
  for (std::size_t i = 0; i < 100; ++i) {
    const NodeFrame frame = bench.frame(i);
    CHECK(frame.origin == DatagramOrigin{7, 0x5eedf00d, static_cast<std::uint32_t>(i)});
    CHECK(!frame.has_echo);
    CHECK(frame.sample_count == (i == 0 ? 5 : 10));
  }
}

TEST_CASE("the counter is read last before sending") {
  Bench bench;
  bench.board.now_us += 50'000;
  bench.board.calls.clear();
  bench.node.poll();
  REQUIRE(bench.board.sent.size() == 1);
  // Calls in their order: does a datagram arrive; is a frame due; battery; n_tx; send.
  CHECK(bench.board.calls == "rcbcs");
  CHECK(bench.last().n_tx_us == bench.board.now_us);
}

TEST_CASE("each sample has its own stamp, read before the sensor") {
  Bench bench;
  std::vector<std::uint64_t> stamps;
  for (const std::uint64_t pause : {9'000, 10'700, 9'900, 11'000}) {  // ticks with jitter
    bench.board.now_us += pause;
    stamps.push_back(bench.board.now_us + 1);
    bench.node.tick(1);
  }
  bench.board.now_us += 10'000;
  bench.node.poll();
  const NodeFrame frame = bench.last();
  REQUIRE(frame.sample_count == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(frame.n_tx_us - frame.samples[i].age_us == stamps[i]);
  }
}

TEST_CASE("what the sensor reads goes out as it is") {
  Bench bench;
  bench.board.reading = {.has_acceleration = true,
                         .has_angular_velocity = true,
                         .has_orientation = true,
                         .gravity_included = true,
                         .acceleration = {0.25F, 9.8125F, -0.5F},
                         .angular_velocity = {0.5F, -0.25F, 0.125F},
                         .orientation = {1, 0, 0, 0}};
  bench.run(60'000);
  NodeSample sample = bench.last().samples[0];
  sample.age_us = 0;
  CHECK(sample == bench.board.reading);
}

TEST_CASE("a sensor that does not answer leaves a sample without values") {
  Bench bench;
  bench.board.reading.has_acceleration = true;  // half filled when the bus broke
  bench.board.imu_answers = false;
  bench.run(60'000);
  const NodeFrame frame = bench.last();
  REQUIRE(frame.sample_count > 0);
  CHECK(!frame.samples[0].has_acceleration);
  CHECK(bench.node.counts().samples.sensor_fails == bench.node.counts().samples.taken);
}

TEST_CASE("two ticks due at once make one sample, and the other is counted") {
  Bench bench;
  bench.node.tick(1);
  bench.node.tick(2);
  bench.node.tick(0);
  bench.board.now_us += 60'000;
  bench.node.poll();
  CHECK(bench.last().sample_count == 2);
  const SampleCounts counts = bench.node.counts().samples;
  CHECK(counts.ticks == 3);
  CHECK(counts.taken == 2);
  CHECK(counts.missed == 1);
}

TEST_CASE("fault 36 sample_batch: of 200 Hz each sample keeps its stamp") {
  Bench bench;
  std::vector<std::uint64_t> stamps, received;
  for (int i = 0; i < 200; ++i) {
    stamps.push_back(bench.board.now_us + 1);
    bench.node.tick(1);
    bench.board.now_us += 5'000;
    bench.node.poll();
  }
  bench.board.now_us += 100'000;
  bench.node.poll();
  for (std::size_t i = 0; i < bench.board.sent.size(); ++i) {
    const NodeFrame frame = bench.frame(i);
    for (std::size_t k = 0; k < frame.sample_count; ++k) {
      received.push_back(frame.n_tx_us - frame.samples[k].age_us);
    }
  }
  CHECK(received == stamps);
}

TEST_CASE("fault 37 firmware_overload: a frame sent 50 ms after its samples states this") {
  Bench bench;
  const std::uint64_t taken = bench.board.now_us + 1;
  bench.node.tick(1);
  bench.board.now_us += bench.node.idle_us(bench.board.now_us) + 90'000;
  bench.node.poll();
  const NodeFrame frame = bench.last();
  CHECK(frame.n_tx_us == bench.board.now_us);
  CHECK(frame.n_tx_us - frame.samples[0].age_us == taken);
}

TEST_CASE("a pause is not followed by a burst of frames") {
  Bench bench;
  bench.run(100'000);
  CHECK(bench.board.sent.size() == 1);
  bench.board.now_us += 1'000'000;
  bench.run(100'000);
  // The frame that is due at once, and the next on its grid.
  CHECK(bench.board.sent.size() == 2 + 1);
  CHECK(bench.node.counts().frames.late == 1);
}

TEST_CASE("more samples than fit are split over frames") {
  Bench bench;
  for (int i = 0; i < 70; ++i) bench.node.tick(1);
  bench.run(300'000);
  REQUIRE(bench.board.sent.size() == 3);
  CHECK(bench.frame(0).sample_count == 30);
  CHECK(bench.frame(1).sample_count == 30);
  CHECK(bench.board.sent[0].size() <= max_node_datagram);
}

TEST_CASE("a key signs every frame") {
  NodeSettings keyed = settings;
  keyed.has_key = true;
  keyed.key = node_key;
  Bench bench(keyed);
  bench.run(1'000'000);
  CHECK(bench.board.sent.size() == 10);
  for (std::size_t i = 0; i < 10; ++i) CHECK(bench.frame(i).origin.sequence == i);
}

TEST_CASE("a battery goes out with each frame where there is one") {
  Bench bench;
  bench.run(60'000);
  CHECK(!bench.last().has_battery);
  bench.board.battery_mv = 3912;
  bench.run(100'000);
  CHECK(bench.last().has_battery);
  CHECK(bench.last().battery_mv == 3912);
}

TEST_CASE("stamps of a narrow counter leave modulo 2^32, ages as they are") {
  NodeSettings narrow = settings;
  narrow.narrow_counter = true;
  Bench bench(narrow);
  bench.board.now_us = (std::uint64_t{1} << 32) - 20'000;
  bench.node.tick(1);
  const std::uint64_t taken = bench.board.now_us - bench.board.imu_takes_us;
  bench.board.now_us += 60'000;
  bench.node.poll();
  const NodeFrame frame = bench.last();
  CHECK(frame.n_tx_us < 100'000);
  CHECK(static_cast<std::uint32_t>(frame.n_tx_us) - frame.samples[0].age_us ==
        static_cast<std::uint32_t>(taken));
  bench.board.arriving.push_back(reply_to(frame, 900));
  bench.run(100'000);
  CHECK(bench.last().has_echo);
  CHECK(bench.last().echo.n_rx_us < 200'000);
}

TEST_CASE("a sample that is later than its frame is not sent: the counter went back") {
  Bench bench;
  bench.node.tick(1);
  bench.board.now_us = 5'000;
  bench.node.tick(1);
  bench.run(200'000);
  CHECK(bench.frame(0).n_tx_us < 200'000);
  CHECK(bench.node.counts().frames.unstampable == 1);
  // And frames do not wait until the counter is back where it was.
  CHECK(bench.board.sent.size() == 2);
}
