// SPDX-License-Identifier: Apache-2.0
// Sends the data of a lab on loopback: five nodes at 100 frames a second that echo their replies,
// mocap at 125 (354 floats, 1480 bytes), a Kinect at 30; all of it `times` as fast. Run by
// record_load.py.
//   record_load MOCAP_PORT KINECT_PORT NODE_PORT TIMES SECONDS
// Prints as JSON the number of messages of each, and the time that the nodes waited for replies:
// half of them, 99 of 100, all.
#include "kinalign/protocols/kinect/binary.h"
#include "kinalign/protocols/noitom/frame.h"
#include "kinalign/wire/node_frame.h"
#include "kinalign/wire/node_reply.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <random>
#include <span>
#include <thread>
#include <utility>
#include <vector>

namespace {

using namespace kinalign;
using Clock = std::chrono::steady_clock;
using Bytes = std::vector<std::uint8_t>;

constexpr std::uint32_t node_count = 5;

/// A socket that sends to one port of this machine.
class Way {
 public:
  explicit Way(std::uint16_t port) : fd_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(fd_, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) std::exit(1);
  }
  Way(Way&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Way(const Way&) = delete;
  Way& operator=(const Way&) = delete;
  Way& operator=(Way&&) = delete;
  ~Way() { ::close(fd_); }

  bool send(std::span<const std::uint8_t> bytes) const {
    return ::send(fd_, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size());
  }
  std::optional<std::size_t> receive(std::span<std::uint8_t> room) const {
    const ssize_t got = ::recv(fd_, room.data(), room.size(), MSG_DONTWAIT);
    return got > 0 ? std::optional(static_cast<std::size_t>(got)) : std::nullopt;
  }

 private:
  int fd_;
};

std::uint64_t microseconds_since(Clock::time_point begin) {
  using std::chrono::microseconds;
  return static_cast<std::uint64_t>(
      std::chrono::duration_cast<microseconds>(Clock::now() - begin).count());
}

class Node {
 public:
  Node(std::uint32_t id, std::uint16_t port, Clock::time_point begin) : way_(port), begin_(begin) {
    frame_.origin = {id, 1000 + id, 0};
    frame_.sample_count = 1;
    frame_.samples[0].has_acceleration = frame_.samples[0].has_angular_velocity = true;
    frame_.samples[0].gravity_included = true;
  }
  void send() {
    NodeSample& sample = frame_.samples[0];
    for (float& a : sample.acceleration) a = noise_(random_);
    for (float& w : sample.angular_velocity) w = noise_(random_);
    sample.age_us = 1000;
    std::array<std::uint8_t, max_node_datagram> room{};
    frame_.n_tx_us = microseconds_since(begin_) + 1'000'000;
    sent_us_[frame_.origin.sequence % sent_us_.size()] = frame_.n_tx_us;
    sent_ += way_.send(encode(frame_, nullptr, room)) ? 1U : 0U;
    ++frame_.origin.sequence;
  }
  void listen() {
    std::array<std::uint8_t, max_node_datagram> room{};
    while (const auto size = way_.receive(room)) {
      const std::uint64_t now = microseconds_since(begin_) + 1'000'000;
      Envelope envelope;
      NodeReply reply;
      if (open_envelope(std::span(room).first(*size), envelope) != NodeRefusal::none ||
          decode(envelope, nullptr, reply) != NodeRefusal::none) {
        continue;
      }
      frame_.has_echo = true;
      frame_.echo = {reply.reply_sequence, reply.nonce, now};
      const std::uint64_t sent = sent_us_[reply.origin.sequence % sent_us_.size()];
      waits_ms_.push_back(1e-3 * static_cast<double>(now - sent));
    }
  }
  std::uint64_t sent() const { return sent_; }
  const std::vector<double>& waits_ms() const { return waits_ms_; }

 private:
  Way way_;
  Clock::time_point begin_;
  NodeFrame frame_;
  std::mt19937_64 random_{1};
  std::normal_distribution<float> noise_;
  std::uint64_t sent_ = 0;
  std::array<std::uint64_t, 4096> sent_us_{};  // us, time at which each frame was sent, by sequence
  std::vector<double> waits_ms_;
};

/// Sends Noitom frames of random floats, which can't be compressed.
class Mocap {
 public:
  explicit Mocap(std::uint16_t port) : way_(port) {
    frame_.name = "Char00";
    frame_.displacement = true;
    frame_.frame_index = 0;
    frame_.values.resize(noitom_values(true, false));
  }
  void send() {
    for (float& value : frame_.values) value = noise_(random_);
    bytes_.clear();
    append_noitom(frame_, bytes_);
    sent_ += way_.send(bytes_) ? 1U : 0U;
    ++*frame_.frame_index;
  }
  std::uint64_t sent() const { return sent_; }

 private:
  Way way_;
  NoitomFrame frame_;
  Bytes bytes_;
  std::mt19937_64 random_{2};
  std::uniform_real_distribution<float> noise_{-180.0F, 180.0F};
  std::uint64_t sent_ = 0;
};

class Kinect {
 public:
  Kinect(std::uint16_t port, Clock::time_point begin) : way_(port), begin_(begin) {
    frame_.origin = {1, 77, 0};
    frame_.bodies.resize(1);
    frame_.bodies[0].id = 1;
    frame_.bodies[0].states.fill(2);
  }
  void send() {
    for (float& value : frame_.bodies[0].positions) value = noise_(random_);
    frame_.device_ticks = static_cast<std::int64_t>(10 * microseconds_since(begin_));
    frame_.taken_ticks = frame_.sent_ticks = frame_.device_ticks;
    sent_ += way_.send(encode_kinect_binary(frame_)) ? 1U : 0U;
    ++frame_.origin.sequence;
  }
  std::uint64_t sent() const { return sent_; }

 private:
  Way way_;
  Clock::time_point begin_;
  KinectFrame frame_;
  std::mt19937_64 random_{3};
  std::normal_distribution<float> noise_;
  std::uint64_t sent_ = 0;
};

/// Calls a function at a rate: each time, the calls that are due.
class Due {
 public:
  explicit Due(double rate_hz) : rate_hz_(rate_hz) {}
  template <class Send>
  void until(double s, Send send) {
    for (; static_cast<double>(done_) < rate_hz_ * s; ++done_) send();
  }

 private:
  double rate_hz_;
  std::uint64_t done_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) return 2;
  const auto port = [&](int i) { return static_cast<std::uint16_t>(std::atoi(argv[i])); };
  const double times = std::clamp(std::atof(argv[4]), 0.01, 1000.0);
  const double length_s = std::clamp(std::atof(argv[5]), 0.0, 1e5);
  const auto begin = Clock::now();
  Mocap mocap(port(1));
  Kinect kinect(port(2), begin);
  std::vector<Node> nodes;
  std::vector<Due> due;
  nodes.reserve(node_count);
  for (std::uint32_t id = 1; id <= node_count; ++id) {
    nodes.emplace_back(id, port(3), begin);
    due.emplace_back(100.0 * times);
  }
  Due mocap_due(125.0 * times), kinect_due(30.0 * times);
  for (double s = 0.0; s < length_s;) {
    std::this_thread::sleep_for(std::chrono::microseconds(500));
    s = std::min(length_s, std::chrono::duration<double>(Clock::now() - begin).count());
    mocap_due.until(s, [&] { mocap.send(); });
    kinect_due.until(s, [&] { kinect.send(); });
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      nodes[i].listen();
      due[i].until(s, [&] { nodes[i].send(); });
    }
  }
  std::printf("{\"mocap\": %lu, \"kinect\": %lu, \"nodes\": [", mocap.sent(), kinect.sent());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    std::printf("%s%lu", i == 0 ? "" : ", ", nodes[i].sent());
  }
  std::vector<double> waits;
  for (const Node& node : nodes) {
    waits.insert(waits.end(), node.waits_ms().begin(), node.waits_ms().end());
  }
  std::sort(waits.begin(), waits.end());
  const auto at = [&](double share) {
    return waits.empty()
               ? 0.0
               : waits[static_cast<std::size_t>(share * static_cast<double>(waits.size() - 1))];
  };
  std::printf("], \"replies\": %zu, \"wait_ms\": [%.3f, %.3f, %.3f]}\n", waits.size(), at(0.5),
              at(0.99), at(1.0));
  return 0;
}
