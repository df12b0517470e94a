// SPDX-License-Identifier: Apache-2.0
// A recording session: the ports of a lab's devices, the recorder, and the disk. One thread
// receives. Takes begin and end while the devices go on sending.
#pragma once

#include "kinalign/capture/live/live_port.h"
#include "kinalign/capture/recorder/mark_ports.h"
#include "kinalign/capture/recorder/recorded_nodes.h"
#include "kinalign/capture/recorder/recorded_port.h"
#include "kinalign/capture/recorder/recorder.h"
#include "kinalign/capture/recorder/session_take.h"
#include "kinalign/recording/counts.h"
#include "kinalign/recording/format.h"
#include "kinalign/take/lab.h"

#include <poll.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kinalign {

class RecordingSession {
 public:
  struct Options {
    Lab lab;
    std::string lab_toml;  // text of lab.toml, stored in each file; may be empty
    // by stream: the head of a BVH file, stored in each file
    std::map<std::string, std::string> skeletons;
    // options of the nodes' port; the keys of other ports come from its secret
    NodeResponderOptions desk;
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

  /// Waits until data arrives, `patience` at most, and processes all of it. It does not wait while
  /// data is held back. `also`: a descriptor of the caller that ends the wait too. Returns whether
  /// any descriptor was ready.
  bool turn(Duration patience, std::optional<int> also = std::nullopt);

  /// Begins a take, which contains the pre-roll and all later data. Its file is opened on the
  /// disk's thread. The take's disk.status() says when that is done, or why it fails.
  void start(const TakePlan& plan) { start(plan, axis_.now()); }
  /// Which start marks begin a take: none, the next one only, or each.
  enum class Starts : std::uint8_t { none, next, each };
  /// Makes marks begin and end takes. A start mark begins a take if none is in progress, and a stop
  /// mark ends it, in the turn in which the mark arrives, regardless of the disk. While takes_ is
  /// full, no take is ended and data goes into the same file.
  void obey_marks(TakePlan plan, Starts starts) { by_marks_ = ByMarks{std::move(plan), starts}; }
  /// Start marks begin no more takes. A stop mark still ends a take in progress.
  void obey_no_start();
  /// Ends the take in progress. Data that has arrived is written to the disk during further calls
  /// of turn(); see the take's disk. A start mark that arrived before the call may have begun
  /// another take.
  void stop();
  bool recording() const { return recorder_->started(); }
  /// The takes that have begun, in order, each once. nullptr: no more.
  std::shared_ptr<SessionTake> next_take() { return takes_.next(); }
  /// The present or last take. nullptr before the first.
  const std::shared_ptr<SessionTake>& newest_take() const { return newest_; }
  /// Bytes of all takes that are not yet safely on the disk.
  std::uint64_t waiting_bytes() const { return takes_.waiting_bytes(); }

  /// Records a mark. Before a take it goes into the pre-roll. The mark may begin or end a take.
  void mark(const RecordedMark& mark, HostTime at) {
    drain_marks();  // marks that arrived earlier come first
    this->mark(mark, Moment{at});
  }
  /// Marks since the previous call, 256 at most.
  std::vector<HeardMark> take_marks() { return std::exchange(marks_, {}); }

  std::vector<StreamStatus> streams() const;
  /// Findings about the devices' data, each once. They are looked for once a second.
  Findings take_findings();
  /// Events of the host's clocks since the previous call.
  std::vector<HostClockEvent> take_clock_events() { return axis_.take_events(); }
  /// The port of each device, by the device's name; also of "marks" and "trigger".
  std::vector<std::pair<std::string, std::uint16_t>> ports() const;
  /// Counts by name as in ports(), for the present or last take. Before the first take they count
  /// from the opening.
  std::vector<std::pair<std::string, PortCounts>> port_counts() const;
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
  void rest(Duration patience);
  std::uint64_t heard() const;
  std::uint64_t held() const;
  bool wait(Duration patience, std::optional<int> also);
  bool is_ready(std::size_t port) const;
  void mark(const RecordedMark& mark, const Moment& came);
  void drain_devices(const Moment& until);
  void release(const std::optional<Moment>& until);
  void drain_marks();
  bool has_room_for_takes();
  void tick(HostTime now);
  void tell(HostTime now);
  void remember_counts(std::uint64_t chunk, std::uint64_t first);
  void begin_counts(std::uint64_t chunk);
  void start(const TakePlan& plan, HostTime at);
  void end_take(const Moment& came);
  std::vector<std::pair<std::string, PortCounts>> running_port_counts() const;

  struct PortPast {
    PastCounts<PortCounts> past;
    PortCounts before{};  // counts before the take
  };

  struct ByMarks {
    TakePlan plan;
    Starts starts = Starts::none;
  };

  Options options_;
  Machine machine_;
  HostAxis axis_;
  std::unique_ptr<Recorder> recorder_;
  std::unique_ptr<RecordedNodes> nodes_;
  std::vector<RecordedPort> ports_;
  std::vector<MarkPort> mark_ports_;
  std::optional<LivePort> live_;
  std::vector<HeardMark> marks_;
  std::uint16_t pairs_ = 0, counts_ = 0, port_counts_ = 0, mark_channel_ = 0;
  RecordingFacts facts_;
  HostTime next_second_ = HostTime::min(), next_look_ = HostTime::min();
  std::map<std::string, PortPast> port_counts_past_;
  std::vector<int> fds_;              // descriptors of this turn
  std::vector<std::size_t> fds_end_;  // end of each port's descriptors in fds_, mark ports last
  std::vector<pollfd> waiting_;
  std::uint64_t heard_before_ = 0;  // heard() at the last turn
  // No rest before this time, because of a flood.
  HostTime awake_until_ = HostTime::min();
  std::optional<ByMarks> by_marks_;
  std::shared_ptr<SessionTake> newest_;
  TakeQueue takes_;
  Findings findings_;
  bool full_ = false;  // takes_ is full, and this was reported
};

}  // namespace kinalign
