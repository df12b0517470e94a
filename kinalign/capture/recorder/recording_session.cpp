// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/recorder/recording_session.h"

#include "kinalign/protocols/protocols.h"

#include <poll.h>

#include <algorithm>
#include <array>
#include <thread>
#include <utility>

namespace kinalign {

namespace {

constexpr Duration between_looks = std::chrono::milliseconds(100);
constexpr std::size_t most_untaken = 256;  // marks kept for take_marks()

/// Returns the MCAP header of each file of a take and of each live stream.
McapHeader recording_header() {
  return {std::string(recording_profile), "kinalign " KINALIGN_VERSION};
}

/// Opens a take's file on the disk's thread, using copies of all data that it needs.
struct TakeFiles {
  FileSystem* files;
  std::function<std::string()> free_path;
  RecordingFacts facts;
  ExpectedDevices expected;
  std::vector<McapAttachment> attachments;

  // If free_path returns the same path again, the name was not the cause of the failure.
  Result<RecordingDisk> operator()() {
    constexpr int most_tries = 100;  // a disk may create names but no files
    std::string path = free_path();
    for (int tries = 1;; ++tries) {
      Result<RecordingDisk> opened = open(path);
      const std::string next = opened ? path : free_path();
      if (next == path || tries == most_tries) return opened;
      path = next;  // another recorder has created this file in the meantime
    }
  }
  // Each file gets a copy of the head, because each file must be readable alone.
  Result<RecordingDisk> open(const std::string& path) {
    facts.first = std::string(file_name(path));
    return RecordingDisk::open(*files, path, [head = *this](int part) mutable -> RecordingHead {
      head.facts.part = part;
      return {recording_header(),
              {to_metadata(head.facts), to_metadata(head.expected)},
              head.attachments};
    });
  }
};

std::vector<McapAttachment> attachments_of(const RecordingSession::Options& options, Time at) {
  const auto utc = static_cast<std::uint64_t>(to_ns(at));
  std::vector<McapAttachment> all;
  if (!options.lab_toml.empty()) {
    all.push_back({utc, utc, "lab.toml", "application/toml", options.lab_toml});
  }
  for (const auto& [stream, bvh] : options.skeletons) {
    all.push_back({utc, utc, stream + ".bvh", "text/plain", bvh});
  }
  return all;
}

/// Only nodes with a place in lab.toml are expected; other nodes are not known in advance.
ExpectedDevices expected_of(const Lab& lab) {
  ExpectedDevices expected;
  for (const DeviceOptions& device : lab.devices) {
    if (device.nodes.empty()) expected[device.name] = device.required;
    for (const auto& [id, place] : device.nodes) {
      expected[device.name + "/" + id] = device.required;
    }
  }
  return expected;
}

/// Derives a separate key for each port, so that no two ports use the same nonces.
SipHashKey key_of_port(const SipHashKey& secret, std::uint8_t port) {
  SipHashKey key{};
  for (std::uint8_t half = 0; half < 2; ++half) {
    const std::array<std::uint8_t, 2> text{port, half};
    const std::uint64_t hash = siphash_2_4(secret, text);
    for (std::size_t i = 0; i < 8; ++i) {
      key[std::size_t{half} * 8 + i] = static_cast<std::uint8_t>(hash >> (8 * i));
    }
  }
  return key;
}

}  // namespace

// If one port can't be opened, the session does not begin. Otherwise the missing device would be
// noticed only in the take.
Result<std::unique_ptr<RecordingSession>> RecordingSession::open(Options options, Machine machine) {
  KA_TRY(validate(options.lab));
  std::unique_ptr<RecordingSession> session(new RecordingSession(std::move(options), machine));
  KA_TRY(session->open_ports());
  return session;
}

// The session's channels are added first, so their numbers are the same in every recording.
RecordingSession::RecordingSession(Options options, Machine machine)
    : options_(std::move(options)), machine_(machine), axis_(machine.ports_clock) {
  opened_ = axis_.now();
  facts_.host = options_.host;
  // This pair of clock readings converts host times to UTC in all takes of this session.
  facts_.anchor = axis_.watch();
  RecorderOptions recorder;
  recorder.pre_roll = from_seconds(options_.lab.record.pre_roll_s);
  recorder.utc_minus_host =
      facts_.anchor.utc.time_since_epoch() - facts_.anchor.raw.time_since_epoch();
  recorder_ = std::make_unique<Recorder>(recorder);
  const auto add_json = [&](std::string_view topic, const McapSchema& schema) {
    return recorder_->add_channel({0, 0, std::string(topic), "json", {}}, &schema);
  };
  pairs_ = add_json(host_clock_topic, clock_pair_schema());
  counts_ = add_json(sender_counts_topic, sender_counts_schema());
  port_counts_ = add_json(port_counts_topic, port_counts_schema());
  mark_channel_ = add_json(marks_topic, mark_schema());
  recorder_->when_closed([this](std::uint64_t next, std::uint64_t first) {
    Counts& counts = past_[next];
    for (const StreamStatus& stream : running_streams()) {
      counts.senders[stream.topic] = stream.counts;
    }
    for (const auto& [name, port] : running_port_counts()) counts.ports[name] = port;
    past_.erase(past_.begin(), past_.lower_bound(first));
  });
}

// A device with the protocol of nodes gets RecordedNodes, any other device a RecordedPort.
Result<void> RecordingSession::open_ports() {
  for (const DeviceOptions& device : options_.lab.devices) {
    const auto protocol = find_protocol(device.protocol);
    if (protocol && row_of(*protocol).answers == Answers::node_requests) {
      nodes_ = KA_TRY(
          RecordedNodes::open(device, options_.node_responder, machine_.nodes_clock, *recorder_));
    } else {
      const auto number = static_cast<std::uint8_t>(ports_.size());
      ports_.push_back(
          KA_TRY(RecordedPort::open(device, key_of_port(options_.node_responder.secret, number))));
    }
  }
  if (options_.marks_port) {
    mark_ports_.push_back(KA_TRY(MarkPort::open(MarkPort::Form::call, *options_.marks_port)));
  }
  if (options_.trigger_port) {
    mark_ports_.push_back(KA_TRY(MarkPort::open(MarkPort::Form::trigger, *options_.trigger_port)));
  }
  if (options_.live_port) KA_TRY(open_live_port(*options_.live_port));
  return {};
}

Result<void> RecordingSession::open_live_port(std::uint16_t port) {
  live_ = KA_TRY(LivePort::open(port, recording_header(),
                                {to_metadata(facts_), to_metadata(expected_of(options_.lab))}));
  recorder_->when_recorded(
      [this](const McapSchema* schema, const McapChannel& channel, const McapMessage& message) {
        if (live_->has_clients()) live_->add(schema, channel, message);
      });
  return {};
}

void RecordingSession::end_live() {
  if (live_) live_->end();
}

// Number of pieces from all devices, including refused ones. Marks are not counted, because they
// are few.
std::uint64_t RecordingSession::received() const {
  std::uint64_t all = nodes_ ? nodes_->receiver().received() : 0;
  for (const RecordedPort& port : ports_) all += port.received();
  return all;
}

/// Pauses before the next read. Waking up costs more than processing a message, so the messages of
/// 20 ms are processed together. If data arrives too fast, there is no rest, because the buffers
/// would fill. Clock estimates are not affected: the kernel stamps arrivals, and the times of each
/// answer are known. Live clients need each message at once, so there is no rest while a client is
/// connected.
void RecordingSession::rest(Duration patience) {
  constexpr Duration short_rest = std::chrono::milliseconds(20);
  constexpr std::uint64_t few = 32;  // pieces in a turn; the kernel's buffers hold twice as many
  const std::uint64_t all = received();
  const std::uint64_t came = all - std::exchange(received_before_, all);
  const HostTime now = axis_.now();
  if (came > few) busy_until_ = now + std::chrono::seconds(1);
  const bool hurries = live_ && live_->has_clients();
  if (came > 0 && now >= busy_until_ && patience >= short_rest && !hurries) {
    std::this_thread::sleep_for(short_rest);
  }
}

/// Marks are read before the devices' data. After each stop mark, all data that has arrived is
/// read, so data that was sent before the stop is in the take.
void RecordingSession::turn(Duration patience, std::optional<int> also) {
  rest(patience);
  wait(patience, also);
  const HostTime now = axis_.now();
  drain_marks();
  if (now >= next_look_) {
    next_look_ = now + between_looks;
    // Silent nodes, heartbeats and pings are handled several times a second.
    if (nodes_) nodes_->receiver().tick();
    for (RecordedPort& port : ports_) port.tick(now);
  }
  drain_devices();
  tick(now);
  if (live_) live_->turn();
  end_take_if_due();
  start_disks();
}

// The list of descriptors is made in each turn, because connections and nodes change.
void RecordingSession::wait(Duration patience, std::optional<int> also) {
  std::vector<int> fds;
  if (nodes_) fds.push_back(nodes_->receiver().fd());
  for (const RecordedPort& port : ports_) port.add_fds(fds);
  for (const MarkPort& port : mark_ports_) port.add_fds(fds);
  if (live_) fds.push_back(live_->fd());
  if (also) fds.push_back(*also);
  std::vector<pollfd> polled;
  polled.reserve(fds.size());
  for (const int fd : fds) polled.push_back({fd, POLLIN, 0});
  const auto ms = std::chrono::ceil<std::chrono::milliseconds>(patience).count();
  ::poll(polled.data(), polled.size(), static_cast<int>(ms));
}

/// Reads a limited amount of the data that has arrived at each port.
void RecordingSession::drain_devices() {
  if (nodes_) nodes_->drain();
  for (RecordedPort& port : ports_) port.drain(axis_, *recorder_);
}

/// Stops after 200 ms, so that a flood of data can't delay the end of a take for longer.
void RecordingSession::drain_until_empty() {
  constexpr Duration longest = std::chrono::milliseconds(200);
  const HostTime begun = axis_.now();
  std::uint64_t before = 0;
  do {
    before = received();
    drain_devices();
  } while (received() != before && axis_.now() - begun < longest);
}

/// Processes the marks of all ports in the order of arrival, because the start and the stop may
/// arrive at different ports.
void RecordingSession::drain_marks() {
  std::vector<ReceivedMark> all;
  for (MarkPort& port : mark_ports_) {
    port.drain(axis_, [&](const RecordedMark& mark, HostTime at) { all.emplace_back(mark, at); });
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.second < b.second; });
  for (const auto& [received, at] : all) mark(received, at);
}

/// A start mark is recorded in the take that it begins, a stop mark in the take that it ends.
void RecordingSession::mark(const RecordedMark& mark, HostTime at) {
  using Kind = Mark::Kind;
  const Kind kind = mark.mark.kind;
  if (kind == Kind::start && may_start()) {
    if (by_marks_->starts == Starts::next) by_marks_->starts = Starts::none;
    // A start mark during a take begins no second take.
    if (!recording()) start(by_marks_->plan, at);
    if (std::exchange(stop_is_due_, false)) {
      findings_.push_back(
          {Severity::warning,
           Error{"marks", 0, "a start mark after the previous take is on the disk",
                 "a start mark before that"},
           "the mark begins no take: the data continues in the same file, with all marks",
           "check what delays the disk, or which program sends so many marks"});
    }
  }
  recorder_->record(mark_channel_, at, to_json(mark));
  // Marks beyond the limit are recorded but not displayed.
  if (marks_.size() < most_untaken) marks_.emplace_back(mark, at);
  if (kind != Kind::stop || !by_marks_) return;
  stop_is_due_ = recording();
  end_take_if_due();
}

// by_marks_ remains set, so stop marks still work.
void RecordingSession::obey_no_start() {
  if (by_marks_) by_marks_->starts = Starts::none;
}

void RecordingSession::tick(HostTime now) {
  recorder_->tick(now);
  if (now < next_second_) return;
  next_second_ = now + std::chrono::seconds(1);
  record_counts(now);
  if (nodes_) nodes_->find_foreign();
}

/// Records both clocks of the host. During a take it records the counts too.
void RecordingSession::record_counts(HostTime now) {
  recorder_->record(pairs_, now, to_json(axis_.watch()));
  for (RecordedPort& port : ports_) port.look(now);
  if (nodes_) nodes_->look(now);
  if (!recording()) return;
  for (const StreamStatus& stream : streams()) {
    // A sender that sent nothing during this take is not counted in it.
    if (stream.counts.messages == 0) continue;
    recorder_->record(
        counts_, now,
        to_json({stream.topic, stream.stream, stream.sender, stream.node, stream.counts}));
  }
  for (const auto& [name, counts] : port_counts()) {
    recorder_->record(port_counts_, now, to_json(CountedPort{name, counts}));
  }
}

/// `at`: begin of the take. The pre-roll is the time before it.
void RecordingSession::start(const TakePlan& plan, HostTime at) {
  const auto compression =
      options_.lab.record.compression == "none" ? McapCompression::none : McapCompression::zstd;
  TakeFiles take_files{&machine_.files, plan.free_path, facts_, expected_of(options_.lab),
                       attachments_of(options_, facts_.anchor.utc)};
  take_files.facts.subject = plan.subject;
  take_files.facts.action = plan.action;
  const std::shared_ptr<SessionTake> take(
      new SessionTake{at, std::nullopt, {std::move(take_files), compression}});
  takes_.push_back(take);
  stop_is_due_ = false;
  const std::uint64_t first = recorder_->start(at, [this, take](McapChunkContent chunk) {
    // All takes share the limit, because a take may begin while the previous take is still being
    // written.
    const std::uint64_t others = waiting_bytes() - take->disk.status().waiting_bytes;
    take->disk.push(std::move(chunk),
                    DiskThread::most_waiting - std::min(others, DiskThread::most_waiting));
  });
  // From now on all counts are those of the take. Before the very first chunk all counts are zero.
  before_ = past_[first];
  start_disks();
}

/// Starts the disk threads, or attempts it again if the system had no thread. The file of the
/// earlier take is opened first, so that files are numbered in the order of takes.
void RecordingSession::start_disks() {
  for (const auto& take : takes_) {
    const DiskStatus disk = take->disk.status();
    if (disk.finished) continue;
    (void)take->disk.start();
    // Later takes wait until this take has its file and thus its number.
    if (disk.paths.empty()) return;
  }
}

// Marks that have arrived are in the take too. They may end this take and begin another one, which
// then continues.
void RecordingSession::stop() {
  if (!recording()) return;
  const auto ending = takes_.back();
  drain_marks();
  stop_is_due_ = stop_is_due_ || (recording() && takes_.back() == ending);
  end_take_if_due();
}

void RecordingSession::end_take_if_due() {
  // If two takes are not released and another start is possible, the end is postponed, because a
  // third take would have no place.
  if (!stop_is_due_ || (takes_.size() > 1 && may_start())) return;
  stop_is_due_ = false;
  drain_until_empty();
  const HostTime now = axis_.now();
  record_counts(now);
  recorder_->stop();
  SessionTake& take = *takes_.back();
  take.end = status();
  take.end->ended = true;
  // Senders that have no message in this take are removed.
  std::erase_if(take.end->streams,
                [](const StreamStatus& one) { return one.counts.messages == 0; });
  take.disk.finish();
}

std::uint64_t RecordingSession::waiting_bytes() const {
  std::uint64_t all = 0;
  for (const auto& take : takes_) all += take->disk.status().waiting_bytes;
  return all;
}

LabStatus RecordingSession::status() {
  LabStatus status{now(), opened_, streams(), {}, port_counts()};
  if (nodes_) status.nodes = nodes_->receiver().status();
  for (const auto& [name, port] : ports()) status.port_numbers[name] = port;
  return status;
}

std::vector<StreamStatus> RecordingSession::streams() {
  std::vector<StreamStatus> all = running_streams();
  for (StreamStatus& stream : all) {
    stream.counts = since(before_.senders[stream.topic], stream.counts);
  }
  return all;
}

// Returns the counts since the session was opened.
std::vector<StreamStatus> RecordingSession::running_streams() {
  std::vector<StreamStatus> all;
  for (RecordedPort& port : ports_) port.add_streams(all);
  if (nodes_) nodes_->add_streams(all);
  return all;
}

Findings RecordingSession::take_findings() {
  Findings all = std::exchange(findings_, {});
  for (RecordedPort& port : ports_) append(all, port.take_findings());
  if (nodes_) append(all, nodes_->take_findings());
  for (MarkPort& port : mark_ports_) append(all, port.take_findings());
  return all;
}

std::vector<std::pair<std::string, std::uint16_t>> RecordingSession::ports() const {
  std::vector<std::pair<std::string, std::uint16_t>> all;
  for (const RecordedPort& port : ports_) all.emplace_back(port.device().name, port.port());
  if (nodes_) all.emplace_back(nodes_->device().name, nodes_->port());
  for (const MarkPort& port : mark_ports_) {
    all.emplace_back(port.name(), port.port());
  }
  return all;
}

std::vector<std::pair<std::string, PortCounts>> RecordingSession::port_counts() {
  auto all = running_port_counts();
  for (auto& [name, counts] : all) counts = since(before_.ports[name], counts);
  return all;
}

// Returns the counts since the session was opened.
std::vector<std::pair<std::string, PortCounts>> RecordingSession::running_port_counts() const {
  std::vector<std::pair<std::string, PortCounts>> all;
  for (const RecordedPort& port : ports_) all.emplace_back(port.device().name, port.counts());
  if (nodes_) all.emplace_back(nodes_->device().name, nodes_->counts());
  for (const MarkPort& port : mark_ports_) all.emplace_back(port.name(), port.port_counts());
  return all;
}

}  // namespace kinalign
