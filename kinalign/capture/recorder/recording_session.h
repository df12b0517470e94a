// SPDX-License-Identifier: Apache-2.0
// A recording session: the ports of a lab's devices, the recorder and the disk. One thread receives
// all data. Takes begin and end while the devices continue to send.
#pragma once

#include "kinalign/capture/live/live_port.h"
#include "kinalign/capture/recorder/disk_thread.h"
#include "kinalign/capture/recorder/lab_status.h"
#include "kinalign/capture/recorder/mark_ports.h"
#include "kinalign/capture/recorder/recorded_nodes.h"
#include "kinalign/capture/recorder/recorded_port.h"
#include "kinalign/capture/recorder/recorder.h"
#include "kinalign/recording/counts.h"
#include "kinalign/recording/format.h"
#include "kinalign/take/lab.h"

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kinalign {

/// A mark and its arrival.
using ReceivedMark = std::pair<RecordedMark, HostTime>;

struct TakePlan {
  /// Returns a path that ends in .mcap and does not exist yet. It is called on the disk's thread,
  /// so it may be slow. It is called again if another recorder has created the file.
  std::function<std::string()> free_path;
  std::string subject{}, action{};
};

/// One take of a session: its file and its result. The session keeps it until release_take(), and
/// the recorder keeps it during the take. Its destructor waits for the disk's threads.
struct SessionTake {
  HostTime begun{};
  std::optional<LabStatus> end;  // absent: the take is in progress
  DiskThread disk;
};

/// One thread calls all functions. All slow work is done by the threads of the takes' disks.
class RecordingSession {
 public:
  struct Options {
    Lab lab;
    std::string lab_toml;  // text of lab.toml, stored in each file; may be empty
    // by stream: the hierarchy of a BVH file, stored in each file
    std::map<std::string, std::string> skeletons;
    // options of the nodes' port; their secret also gives the keys of the other ports
    NodeResponderOptions node_responder;
    std::string host;                                       // the machine's name
    std::optional<std::uint16_t> marks_port, trigger_port;  // absent: no such port
    std::optional<std::uint16_t> live_port;                 // absent: no live port
  };
  /// Access to the machine. `files` and the clocks must outlive the session. The two clock readers
  /// must be different objects.
  struct Machine {
    FileSystem& files;
    ClockReader& ports_clock;
    ClockReader& nodes_clock;
  };
  /// Opens all ports.
  static Result<std::unique_ptr<RecordingSession>> open(Options options, Machine machine);

  /// Waits until data arrives, at most for `patience`, and processes it. Data on the descriptor
  /// `also` ends the wait too.
  void turn(Duration patience, std::optional<int> also = std::nullopt);

  /// Begins a take, which contains the pre-roll and all later data. No take may be in progress. The
  /// disk's thread opens the file. The take's disk.status() tells when the file is open, or why
  /// opening failed.
  void start(const TakePlan& plan) { start(plan, axis_.now()); }
  /// The start marks that begin a take: none, only the next one, or each.
  enum class Starts : std::uint8_t { none, next, each };
  /// Makes marks begin and end takes. A start mark begins a take if none is in progress. A stop
  /// mark ends the take, see stop(). The take begins or ends in the turn in which the mark is read.
  void obey_marks(TakePlan plan, Starts starts) { by_marks_ = ByMarks{std::move(plan), starts}; }
  /// From now on, start marks begin no take. A stop mark still ends the take in progress.
  void obey_no_start();
  /// Ends the take in progress. It contains all data and marks that have arrived. While the
  /// previous take is not released and another take may begin, the end is postponed.
  void stop();
  bool recording() const { return recorder_->started(); }
  /// The takes that are not released, at most two. The last take is in progress or has ended; the
  /// take before it has ended.
  const std::deque<std::shared_ptr<SessionTake>>& takes() const { return takes_; }
  /// Removes the oldest take. Call when the take is written or abandoned.
  void release_take() { takes_.pop_front(); }
  /// Bytes of all takes that are not yet safely on the disk.
  std::uint64_t waiting_bytes() const;

  /// Records a mark. Before a take, the mark goes into the pre-roll. The mark may begin or end a
  /// take.
  void mark(const RecordedMark& mark, HostTime at);
  /// Marks since the previous call, at most 256.
  std::vector<ReceivedMark> take_marks() { return std::exchange(marks_, {}); }

  /// The status of the lab, with the counts of the present or last take. Before the first take, the
  /// counts begin with the opening of the ports.
  LabStatus status();
  /// Parts of the status.
  std::vector<StreamStatus> streams();
  std::vector<std::pair<std::string, PortCounts>> port_counts();
  /// Findings about the devices' data since the previous call, each only once. The session looks
  /// for them once a second.
  Findings take_findings();
  /// Events of the host's clocks since the previous call.
  std::vector<HostClockEvent> take_clock_events() { return axis_.take_events(); }
  /// The port number of each device, by the device's name, and of "marks" and "trigger".
  std::vector<std::pair<std::string, std::uint16_t>> ports() const;
  const std::vector<MarkPort>& mark_ports() const { return mark_ports_; }
  /// Returns nullptr if the session has no live port.
  const LivePort* live() const { return live_ ? &*live_ : nullptr; }
  /// Call after the last message. Writes the end of the live streams.
  void end_live();
  /// Returns nullptr if the lab has no nodes.
  NodeReceiver* nodes() { return nodes_ ? &nodes_->receiver() : nullptr; }
  const Lab& lab() const { return options_.lab; }
  HostTime now() { return axis_.now(); }

 private:
  RecordingSession(Options options, Machine machine);
  Result<void> open_ports();
  Result<void> open_live_port(std::uint16_t port);
  /// The steps of a turn, in this order: rest, wait, marks, devices, tick, live clients, end of a
  /// take, files.
  void rest(Duration patience);
  void wait(Duration patience, std::optional<int> also);
  std::uint64_t received() const;
  void drain_devices();
  void drain_until_empty();
  void drain_marks();
  bool may_start() const { return by_marks_ && by_marks_->starts != Starts::none; }
  void end_take_if_due();
  void start_disks();
  void tick(HostTime now);
  void record_counts(HostTime now);
  void start(const TakePlan& plan, HostTime at);
  std::vector<StreamStatus> running_streams();
  std::vector<std::pair<std::string, PortCounts>> running_port_counts() const;

  /// Counts since the opening of the ports: of senders by topic, of ports by name.
  struct Counts {
    std::map<std::string, SenderCounts> senders;
    std::map<std::string, PortCounts> ports;
  };

  /// The plan for all takes that marks begin.
  struct ByMarks {
    TakePlan plan;
    Starts starts = Starts::none;
  };

  /// The nodes' port calls the recorder, and the recorder calls the session and the live port. The
  /// session must therefore not move in memory.
  Options options_;
  Machine machine_;
  HostAxis axis_;
  std::unique_ptr<Recorder> recorder_;
  std::unique_ptr<RecordedNodes> nodes_;
  std::vector<RecordedPort> ports_;
  std::vector<MarkPort> mark_ports_;
  std::optional<LivePort> live_;
  std::vector<ReceivedMark> marks_;
  std::uint16_t pairs_ = 0, counts_ = 0, port_counts_ = 0, mark_channel_ = 0;
  RecordingFacts facts_;
  HostTime opened_{};
  HostTime next_second_ = HostTime::min(), next_look_ = HostTime::min();
  /// The counts before each chunk with which a take may begin, by the number of the chunk. A take
  /// begins with the pre-roll, so its counts begin with the values before the pre-roll.
  std::map<std::uint64_t, Counts> past_;
  Counts before_;                      // counts before the take
  std::uint64_t received_before_ = 0;  // value of received() in the last turn
  // No rest before this time, because data arrives too fast.
  HostTime busy_until_ = HostTime::min();
  std::optional<ByMarks> by_marks_;
  /// At most two: the take in progress or the last take, and the take before it.
  std::deque<std::shared_ptr<SessionTake>> takes_;
  bool stop_is_due_ = false;  // the take in progress ends as soon as it may end
  Findings findings_;
};

}  // namespace kinalign
