// SPDX-License-Identifier: Apache-2.0
// The nodes' port while it is recorded: every datagram that got past port and key stands in the
// file as it came, whatever becomes of it; what an accepted one says of its node's clock, too.
#pragma once

#include "kinalign/capture/net/pieces.h"
#include "kinalign/capture/nodes/node_receiver.h"
#include "kinalign/capture/recorder/findings_once.h"
#include "kinalign/capture/recorder/held_back.h"
#include "kinalign/capture/recorder/recorded_source.h"
#include "kinalign/take/lab.h"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace kinalign {

class RecordedNodes {
 public:
  /// `clocks` and `recorder` have to stay.
  static Result<std::unique_ptr<RecordedNodes>> open(const DeviceOptions& device,
                                                     const NodeDeskOptions& desk,
                                                     ClockReader& clocks, Recorder& recorder);
  RecordedNodes(const RecordedNodes&) = delete;
  RecordedNodes& operator=(const RecordedNodes&) = delete;
  ~RecordedNodes() = default;

  /// These as RecordedPort has them.
  void drain(const std::optional<Moment>& until = std::nullopt);
  void release(const std::optional<Moment>& until = std::nullopt);

  std::size_t held() const { return held_.size(); }

  NodeReceiver& receiver() { return receiver_; }
  const NodeReceiver& receiver() const { return receiver_; }
  /// These for each node, as RecordedSource has them.
  void look(HostTime now);
  void remember(std::uint64_t chunk, std::uint64_t first);
  void begin(std::uint64_t chunk);
  void tell(std::uint16_t counts, HostTime now) const;

  const DeviceOptions& device() const { return device_; }
  std::uint16_t port() const { return receiver_.sockets().front().port(); }
  PortCounts counts() const;
  /// Once a second: whether others than nodes send here.
  void find_strays();
  /// As RecordedPort has them.
  Findings take_findings() { return findings_.take(); }
  void add_streams(std::vector<StreamStatus>& all) const;

 private:
  /// What one stream of the receiver's has lost in its present life, and before.
  struct Lost {
    std::uint64_t lives = 0, present = 0, before = 0;
  };
  struct Node {
    RecordedSource raw;
    std::uint16_t exchanges = 0;  // channel
    BootKey boot = 0;             // of the newest frame, …
    std::uint64_t newest = 0;     // … and its number
    std::map<std::size_t, Lost> lost{};
  };

  struct Held {
    NodeArrival arrival;
    NodeNews news;
    std::vector<std::uint8_t> bytes;
    std::vector<NodeReading> readings;
  };

  RecordedNodes(DeviceOptions device, bool keyed, NodeReceiver receiver, Recorder& recorder);
  void take(const NodeArrival& arrival, const NodeNews& news);
  Node& node_of(std::uint32_t id, const NodeAddress& from);
  static void judge(Node& node, const NodeNews& news);
  void count_lost();

  DeviceOptions device_;
  bool keyed_;
  NodeReceiver receiver_;
  Recorder& recorder_;
  std::map<std::uint32_t, Node> nodes_;
  std::optional<Moment> until_;  // what comes later is held back
  HeldBack<Held> held_;
  std::uint64_t bytes_ = 0;
  std::uint64_t crowded_ = 0;  // datagrams of nodes that got no channel
  std::uint64_t dropped_ = 0;  // when strays were looked for last
  FindingsOnce findings_;
};

}  // namespace kinalign
