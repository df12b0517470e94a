// SPDX-License-Identifier: Apache-2.0
// A lab while it records: the devices' ports, the recorder behind them and the disk behind that.
// One thread receives; takes begin and end while devices go on.
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
    std::string lab_toml;  // its text, which goes into the file; may be empty
    std::map<std::string, std::string> skeletons;  // by stream: a BVH's head, which goes there too
    NodeDeskOptions desk;                          // of the nodes' port; others' come from its
                                                   // secret
    std::string host;                              // the machine's name
    std::optional<std::uint16_t> marks_port, trigger_port;  // absent: none
    std::optional<std::uint16_t> live_port;                 // absent: none
  };
  /// Opens all ports. `files` and the clocks have to stay; each clock reader is read by one part
  /// alone.
  struct Machine {
    FileSystem& files;
    ClockReader& ports_clock;
    ClockReader& nodes_clock;
  };
  static Result<std::unique_ptr<RecordingSession>> open(Options options, Machine machine);

  /// Waits for something to come, but no longer than that, and not while something is held back,
  /// and takes it all. `also`: a descriptor of the caller's to wake up for. Whether something came.
  bool turn(Duration patience, std::optional<int> also = std::nullopt);

  /// A take begins: the pre-roll and all that comes from now on is in it. Its file is begun on the
  /// disk's thread; the take's disk.status() says once it is done, or why it can't be.
  void start(const TakePlan& plan) { start(plan, axis_.now()); }
  enum class Starts : std::uint8_t { none, next, each };
  /// From now on start marks begin takes, where none goes on, and a stop mark ends it, each in the
  /// turn in which it comes, whatever the disk is doing: but while takes_ is full none is ended,
  /// and what comes stands in the same file.
  void obey_marks(TakePlan plan, Starts starts) { by_marks_ = ByMarks{std::move(plan), starts}; }
  /// A mark begins no take any more; one that goes on is still ended by one.
  void obey_no_start();
  /// Ends the take that goes on: what has come to the machine goes to the disk, see the take's
  /// disk; turn() looks after that. Marks that came meanwhile may have begun another one.
  void stop();
  bool recording() const { return recorder_->started(); }
  /// Those that began, in their order, each once; nullptr: none more.
  std::shared_ptr<SessionTake> next_take() { return takes_.next(); }
  /// The present or last one; nullptr before the first.
  const std::shared_ptr<SessionTake>& newest_take() const { return newest_; }
  /// Bytes of all takes that only memory has.
  std::uint64_t waiting_bytes() const { return takes_.waiting_bytes(); }

  /// Onto the channel of marks; before a take into its pre-roll. It may begin or end one.
  void mark(const RecordedMark& mark, HostTime at) {
    drain_marks();  // all that came so far
    this->mark(mark, Moment{at});
  }
  /// All marks since this was asked last, at most some hundred.
  std::vector<HeardMark> take_marks() { return std::exchange(marks_, {}); }

  std::vector<StreamStatus> streams() const;
  /// What the user should know of what devices send, each once; looked for once a second.
  Findings take_findings();
  /// What became of the host's clocks since this was asked last.
  std::vector<HostClockEvent> take_clock_events() { return axis_.take_events(); }
  /// By the device's name, or "marks" and "trigger": the port that it is heard on.
  std::vector<std::pair<std::string, std::uint16_t>> ports() const;
  /// As ports(); of the present or last take, before the first since they were opened.
  std::vector<std::pair<std::string, PortCounts>> port_counts() const;
  const std::vector<MarkPort>& mark_ports() const { return mark_ports_; }
  /// Where what is recorded is served meanwhile; nullptr where nobody asked for it.
  const LivePort* live() const { return live_ ? &*live_ : nullptr; }
  /// Nothing more is recorded: live streams end in order.
  void end_live();
  /// nullptr where the lab has no nodes.
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
    PortCounts before{};  // the take
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
  std::vector<int> fds_;              // of this turn
  std::vector<std::size_t> fds_end_;  // by port, marks' last: where in fds_ those of the next begin
  std::vector<pollfd> waiting_;
  std::uint64_t heard_before_ = 0;  // the last turn
  HostTime awake_until_ = HostTime::min();
  std::optional<ByMarks> by_marks_;
  std::shared_ptr<SessionTake> newest_;
  TakeQueue takes_;
  Findings findings_;
  bool full_ = false;  // takes_; and told so
};

}  // namespace kinalign
