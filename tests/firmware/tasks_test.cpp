// SPDX-License-Identifier: Apache-2.0
// Sampling in a task of its own beside the sending task; ./dev tsan checks it for data races.
#include "firmware/node/node.h"
#include "tests/firmware/fake_board.h"

#include <atomic>
#include <mutex>
#include <thread>

using namespace kinalign;

namespace {

/// Its counter goes up by 100 us at each call, and its sensor gives the sample's number.
class TwoTaskBoard : public Board {
 public:
  std::uint64_t counter_us() override { return now_us_ += 100; }
  bool read_imu(NodeSample& sample) override {
    sample.has_acceleration = true;
    sample.acceleration[0] = static_cast<float>(read_++);
    return true;
  }
  bool send(std::span<const std::uint8_t> datagram) override {
    sent.emplace_back(datagram.begin(), datagram.end());
    return true;
  }
  bool receive(std::span<std::uint8_t>, std::size_t&) override { return false; }
  bool read_battery(std::uint16_t&) override { return false; }
  void show(const Lights&) override {}
  void lock() override { mutex_.lock(); }
  void unlock() override { mutex_.unlock(); }

  std::vector<Bytes> sent;

 private:
  std::atomic<std::uint64_t> now_us_ = 0;
  int read_ = 0;
  std::mutex mutex_;
};

}  // namespace

TEST_CASE("samples taken in a task of their own all arrive or are counted, in order") {
  TwoTaskBoard board;
  Node node(board, {.node_id = 7, .boot_id = 9, .frame_period_us = 5'000});
  node.set_link(true);
  constexpr std::uint64_t ticks = 20'000;
  std::atomic<bool> done = false;
  std::thread sampling([&] {
    for (std::uint64_t i = 0; i < ticks; ++i) {
      node.tick(1);
      if (i % 16 == 0) std::this_thread::yield();
    }
    done = true;
  });
  while (!done) node.poll();
  sampling.join();
  for (int i = 0; i < 2000; ++i) node.poll();
  const NodeTally counts = node.counts();
  CHECK(counts.samples.taken == ticks);
  CHECK(counts.frames.samples_sent + counts.samples.dropped == ticks);
  float newest = -1;
  std::uint64_t newest_us = 0;
  for (const Bytes& bytes : board.sent) {
    const auto frame = decoded<NodeFrame>(bytes);
    for (std::size_t i = 0; i < frame.sample_count; ++i) {
      const std::uint64_t taken_us = frame.n_tx_us - frame.samples[i].age_us;
      CHECK(frame.samples[i].acceleration[0] > newest);
      CHECK(taken_us > newest_us);
      newest = frame.samples[i].acceleration[0];
      newest_us = taken_us;
    }
  }
  CHECK(newest == ticks - 1);
}
