// SPDX-License-Identifier: Apache-2.0
// The nodes' port during recording. Each datagram that passed the checks of port and key is
// recorded as received, even if it is not accepted. The clock exchanges of accepted datagrams are
// recorded too.
#pragma once

#include "kinalign/capture/net/pieces.h"
#include "kinalign/capture/nodes/node_receiver.h"
#include "kinalign/capture/recorder/findings_once.h"
#include "kinalign/capture/recorder/recorded_source.h"
#include "kinalign/take/lab.h"

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

namespace kinalign {

/// Not movable, because the receiver calls this object.
class RecordedNodes {
 public:
  /// `clocks` and `recorder` must outlive the object.
  static Result<std::unique_ptr<RecordedNodes>> open(const DeviceOptions& device,
                                                     const NodeResponderOptions& responder,
                                                     ClockReader& clocks, Recorder& recorder);
  RecordedNodes(const RecordedNodes&) = delete;
  RecordedNodes& operator=(const RecordedNodes&) = delete;
  ~RecordedNodes() = default;

  /// The public functions below are like those of RecordedPort.
  void drain() { receiver_.drain(); }

  NodeReceiver& receiver() { return receiver_; }
  const NodeReceiver& receiver() const { return receiver_; }
  void look(HostTime now);

  const DeviceOptions& device() const { return device_; }
  std::uint16_t port() const { return receiver_.sockets().front().port(); }
  PortCounts counts() const;
  /// Call once a second. Checks whether devices other than nodes send to this port.
  void find_foreign();
  Findings take_findings() { return findings_.take(); }
  void add_streams(std::vector<StreamStatus>& all);

 private:
  /// Lost frames of one stream of the receiver: in its present session and in all earlier sessions.
  struct Lost {
    std::uint64_t sessions = 0, present = 0, before = 0;
  };
  /// One node id. Two nodes with the same id share two channels.
  struct Node {
    RecordedSource raw;
    std::uint16_t exchanges = 0;  // channel of the clock exchanges
    BootKey boot = 0;             // session of the newest frame
    // Losses by the receiver's stream number.
    std::map<std::size_t, Lost> lost{};
  };

  RecordedNodes(DeviceOptions device, bool keyed, NodeReceiver receiver, Recorder& recorder);
  /// Called by the receiver for each datagram that passed the checks of port and key.
  void take(const NodeArrival& arrival, const NodeMessage& message);
  Node& node_of(std::uint32_t id, const NodeAddress& from);
  /// `judge` counts a datagram by its verdict when it arrives. `count_lost` reads the losses from
  /// the receiver when the status is needed.
  static void judge(Node& node, const NodeMessage& message);
  void count_lost();

  DeviceOptions device_;
  bool keyed_;
  NodeReceiver receiver_;
  Recorder& recorder_;
  std::map<std::uint32_t, Node> nodes_;
  std::uint64_t bytes_ = 0;
  std::uint64_t without_channel_ = 0;  // datagrams of nodes without a channel
  std::uint64_t dropped_ = 0;          // dropped datagrams at the last call of find_foreign()
  FindingsOnce findings_;
};

}  // namespace kinalign
