// SPDX-License-Identifier: Apache-2.0
// Recording sessions over loopback, and the contents of their files.
#pragma once

#include "tests/capture/loopback.h"
#include "tests/folder.h"
#include "tests/mcap/mcap_files.h"

#include "kinalign/capture/recorder/recording_session.h"

#include <doctest/doctest.h>

#include <map>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace kinalign {

struct RecordingMachine {
  PosixFiles files;
  SystemClocks ports_clock, nodes_clock;

  RecordingSession::Machine parts() { return {files, ports_clock, nodes_clock}; }
};

inline void start(RecordingSession& session, const std::string& path,
                  const std::string& subject = "", const std::string& action = "") {
  while (!session.takes().empty()) session.release_take();
  session.start({[path] { return path; }, subject, action});
}

inline void finish(RecordingSession& session) {
  session.stop();
  while (!session.takes().back()->disk.status().finished) std::this_thread::yield();
}

/// Payloads by topic, in their order.
inline std::map<std::string, std::vector<std::string>> payloads_in(const std::string& bytes) {
  const ReadMcap read = read_mcap(bytes);
  CHECK(read.closed);
  CHECK(read.findings.empty());
  std::map<std::uint16_t, std::string> topics;
  for (const McapRecord& record : read.records) {
    if (const auto* channel = std::get_if<McapChannel>(&record))
      topics[channel->id] = channel->topic;
  }
  std::map<std::string, std::vector<std::string>> payloads;
  for (const OwnedMessage& m : read.messages) payloads[topics[m.message.channel]].push_back(m.data);
  return payloads;
}

inline std::vector<std::uint8_t> bytes_of(const std::string& text) {
  return {text.begin(), text.end()};
}

/// A session that records from its start on.
class LiveSession {
 public:
  explicit LiveSession(const std::vector<std::string>& devices,
                       RecordingSession::Options options = {}) {
    for (const std::string& text : devices) {
      auto device = parse_device(text);
      REQUIRE(device);
      options.lab.devices.push_back(*std::move(device));
    }
    auto opened = RecordingSession::open(std::move(options), machine_.parts());
    REQUIRE(opened);
    session_ = *std::move(opened);
    start(*session_, folder_ / "a.mcap");
  }

  RecordingSession& session() { return *session_; }
  const RecordingSession& session() const { return *session_; }
  /// The port of the first device.
  std::uint16_t port() const { return session_->ports().front().second; }
  std::uint64_t pieces() const { return session_->port_counts().front().second.pieces; }
  template <class Holds>
  void serve_until(const Holds& holds) {  // CTest's own limit ends a test that hangs
    while (!holds()) session_->turn(std::chrono::milliseconds(10));
  }
  std::map<std::string, std::vector<std::string>> finish() {
    kinalign::finish(*session_);
    return payloads_in(folder_.read("a.mcap"));
  }

 private:
  FreshFolder folder_;
  RecordingMachine machine_;
  std::unique_ptr<RecordingSession> session_;
};

/// A connection of a device to the recorder.
class Connection {
 public:
  explicit Connection(std::uint16_t port) : fd_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    REQUIRE(::connect(fd_, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0);
    const timeval patience{2, 0};
    ::setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection() { ::close(fd_); }

  void send(const std::string& text) const {
    CHECK(::write(fd_, text.data(), text.size()) == static_cast<ssize_t>(text.size()));
  }
  /// The datagram that came; empty if none came within two seconds.
  std::string receive() const {
    std::string text(2048, '\0');
    const ssize_t got = ::read(fd_, text.data(), text.size());
    text.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
    return text;
  }

 private:
  int fd_;
};

}  // namespace kinalign
