// SPDX-License-Identifier: Apache-2.0
// A lab while it records: the devices' ports, the recorder behind them and the disk behind that.
// One thread receives; takes begin and end while devices go on.
#pragma once

#include "kinalign/capture/disk_thread.h"
#include "kinalign/capture/node_receiver.h"
#include "kinalign/capture/pieces.h"
#include "kinalign/capture/recorder.h"
#include "kinalign/capture/stream_watch.h"
#include "kinalign/io/recording_format.h"
#include "kinalign/take/lab.h"

#include <poll.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace kinalign {

/// How a stream does: one sender's, or one node's.
struct StreamStatus {
  std::string stream, sender;
  std::string node, place;  // of nodes: the id, and where the lab says that it is worn
  SenderCounts counts;      // since it was first heard
  double rate_hz = 0.0;     // messages, over the last second
  HostTime heard{};         // last
};

class RecordingSession {
 public:
  struct Options {
    Lab lab;
    std::string lab_toml;  // its text, which goes into the file; may be empty
    std::map<std::string, std::string> skeletons;  // by stream: a BVH's head, which goes there too
    NodeDeskOptions desk;                          // of the nodes' port
    std::string host;                              // the machine's name
  };
  /// Opens all ports. `files` and the clocks have to stay; each clock reader is read by one part
  /// alone.
  struct Machine {
    FileSystem& files;
    ClockReader& ports_clock;
    ClockReader& nodes_clock;
  };
  static Result<std::unique_ptr<RecordingSession>> open(Options options, Machine machine);

  /// Waits for something to come, but no longer than that, and takes it all.
  void turn(Duration patience);

  /// Begins a take with the pre-roll; `path` ends in .mcap and must be free.
  Result<void> start(const std::string& path, const std::string& subject,
                     const std::string& action);
  /// Ends it: what has come goes to the disk, see disk().finished.
  void stop();
  bool recording() const { return recorder_->started(); }

  /// Of the present or last take; absent before the first.
  std::optional<DiskStatus> disk() const;
  std::vector<PartFailure> take_disk_failures();
  std::vector<StreamStatus> streams() const;
  /// By the device's name: the port that it is heard on.
  std::vector<std::pair<std::string, std::uint16_t>> ports() const;
  std::vector<std::pair<std::string, PortCounts>> port_counts() const;
  NodeReceiver* nodes() { return nodes_ ? &*nodes_ : nullptr; }
  const Lab& lab() const { return options_.lab; }
  HostTime now() { return axis_.now(); }

 private:
  /// One channel of raw payloads and what came on it.
  struct Source {
    StreamStatus status;
    StreamWatch watch{};
    std::uint16_t channel = 0;
    std::uint64_t life = 0;          // of its sender
    std::uint64_t second_began = 0;  // messages then
  };
  struct Port {
    std::size_t device = 0;  // in the lab
    std::variant<UdpPieces, TcpPieces> pieces;
    std::vector<Source> sources{};           // by the sender's number
    std::size_t fds_begin = 0, fds_end = 0;  // in fds_
  };
  struct NodeSource {
    Source raw;
    std::uint16_t exchanges = 0;  // channel
  };

  RecordingSession(Options options, Machine machine);
  Result<void> open_ports();
  void take_piece(Port& port, const Piece& piece);
  void take_node(const NodeArrival& arrival, const NodeNews& news);
  NodeSource& node_source(std::uint32_t node_id, const std::string& sender);
  Source new_source(const std::string& topic, const RawChannel& raw);
  void tick(HostTime now);
  void measure(Source& source, double elapsed_s, HostTime now);

  Options options_;
  Machine machine_;
  HostAxis axis_;
  std::optional<NodeReceiver> nodes_;
  std::size_t nodes_device_ = 0;
  std::vector<Port> ports_;
  std::map<std::uint32_t, NodeSource> node_sources_;
  std::unique_ptr<Recorder> recorder_;
  std::uint16_t pairs_ = 0, counts_ = 0;  // channels
  RecordingFacts facts_;
  HostTime next_second_ = HostTime::min(), next_look_ = HostTime::min();
  std::vector<int> fds_;  // of this turn
  std::vector<pollfd> waiting_;
  std::unique_ptr<DiskThread> disk_;
};

}  // namespace kinalign
