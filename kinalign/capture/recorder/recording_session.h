// SPDX-License-Identifier: Apache-2.0
// A recording session: the ports of a lab's devices, the recorder, and the disk. One thread
// receives. Takes begin and end while the devices go on sending.
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
  /// where it may take long. It is called again if another recorder has taken the name.
  std::function<std::string()> free_path;
  std::string subject{}, action{};
};

/// A take of a session: its file and its result. The session keeps it until release_take(), and the
/// recorder while the take is in progress. Its destructor waits for the disk's threads.
struct SessionTake {
  HostTime begun{};
  std::optional<LabStatus> end;  // absent: the take is in progress
  DiskThread disk;
};

/// One thread calls all functions. Everything that may wait is on the threads of the takes' disks.
class RecordingSession {
 public:
  struct Options {
    Lab lab;
    std::string lab_toml;  // text of lab.toml, stored in each file; may be empty
    // by stream: the head of a BVH file, stored in each file
    std::map<std::string, std::string> skeletons;
    // options of the nodes' port; the keys of other ports come from its secret
    NodeResponderOptions node_responder;
    std::string host;                                       // the machine's name
    std::optional<std::uint16_t> marks_port, trigger_port;  // absent: no such port
    std::optional<std::uint16_t> live_port;                 // absent: no live port
  };
  /// Opens all ports. `files` and the clocks must outlive the session. Each clock reader is used by
  /// one part only.
  struct Machine {
    FileSystem& files;
    ClockReader& ports_clock;
    ClockReader& nodes_clock;
  };
  static Result<std::unique_ptr<RecordingSession>> open(Options options, Machine machine);

  /// Waits until data arrives, `patience` at most, and processes it. `also`: a descriptor of the
  /// caller that ends the wait too.
  void turn(Duration patience, std::optional<int> also = std::nullopt);

  /// Begins a take, which contains the pre-roll and all later data. No take may be in progress. The
  /// file is opened on the disk's thread. The take's disk.status() says when that is done, or why
  /// it fails.
  void start(const TakePlan& plan) { start(plan, axis_.now()); }
  /// Which start marks begin a take: none, the next one only, or each.
  enum class Starts : std::uint8_t { none, next, each };
  /// Makes marks begin and end takes. A start mark begins a take if none is in progress. A stop
  /// mark ends it, see stop(). The boundary is the turn in which the mark is read.
  void obey_marks(TakePlan plan, Starts starts) { by_marks_ = ByMarks{std::move(plan), starts}; }
  /// Start marks begin no more takes. A stop mark still ends a take in progress.
  void obey_no_start();
  /// Ends the take in progress. All data and marks that have arrived are in it. If another take may
  /// begin while the take before this one is not released, this take continues until then.
  void stop();
  bool recording() const { return recorder_->started(); }
  /// The takes that are not released, two at most: the last one is in progress or has ended, the
  /// one before it has ended.
  const std::deque<std::shared_ptr<SessionTake>>& takes() const { return takes_; }
  /// Forgets the oldest take. Call when it is written or given up.
  void release_take() { takes_.pop_front(); }
  /// Bytes of all takes that are not yet safely on the disk.
  std::uint64_t waiting_bytes() const;

  /// Records a mark. Before a take it goes into the pre-roll. The mark may begin or end a take.
  void mark(const RecordedMark& mark, HostTime at);
  /// Marks since the previous call, 256 at most.
  std::vector<ReceivedMark> take_marks() { return std::exchange(marks_, {}); }

  /// The status of the lab, with counts of the present or last take. Before the first take they
  /// count from the opening.
  LabStatus status();
  /// These are parts of the status.
  std::vector<StreamStatus> streams();
  std::vector<std::pair<std::string, PortCounts>> port_counts();
  /// Findings about the devices' data, each once. They are looked for once a second.
  Findings take_findings();
  /// Events of the host's clocks since the previous call.
  std::vector<HostClockEvent> take_clock_events() { return axis_.take_events(); }
  /// The port of each device, by the device's name; also of "marks" and "trigger".
  std::vector<std::pair<std::string, std::uint16_t>> ports() const;
  const std::vector<MarkPort>& mark_ports() const { return mark_ports_; }
  /// The live port. nullptr if the options ask for none.
  const LivePort* live() const { return live_ ? &*live_ : nullptr; }
  /// Call when nothing more is recorded. Ends the live streams properly.
  void end_live();
  /// nullptr if the lab has no nodes.
  NodeReceiver* nodes() { return nodes_ ? &nodes_->receiver() : nullptr; }
  const Lab& lab() const { return options_.lab; }
  HostTime now() { return axis_.now(); }

 private:
  RecordingSession(Options options, Machine machine);
  Result<void> open_ports();
  Result<void> open_live_port(std::uint16_t port);
  /// The steps of a turn, in this order: rest, wait, marks, devices, tick, live clients, the end of
  /// a take, files.
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

  /// Counts since the opening at one moment: of senders by topic, of ports by name.
  struct Counts {
    std::map<std::string, SenderCounts> senders;
    std::map<std::string, PortCounts> ports;
  };

  /// The takes that marks begin all follow one plan.
  struct ByMarks {
    TakePlan plan;
    Starts starts = Starts::none;
  };

  /// The nodes' port calls back into the recorder, and the recorder calls back into the session and
  /// the live port. So the session stays at one place in memory.
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
  /// The counts before each chunk with which a take may begin, by the chunk's number. A take begins
  /// with the chunks of its pre-roll, so its counts begin with the values before these chunks.
  std::map<std::uint64_t, Counts> past_;
  Counts before_;                      // counts before the take
  std::uint64_t received_before_ = 0;  // received() at the last turn
  // No rest before this time, because of a flood.
  HostTime busy_until_ = HostTime::min();
  std::optional<ByMarks> by_marks_;
  /// At most two: the take in progress, or the last one, and the one before it.
  std::deque<std::shared_ptr<SessionTake>> takes_;
  bool stop_is_due_ = false;  // the take in progress ends as soon as it may
  Findings findings_;
};

}  // namespace kinalign
