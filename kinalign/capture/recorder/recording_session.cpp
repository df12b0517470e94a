// SPDX-License-Identifier: Apache-2.0
#include "kinalign/capture/recorder/recording_session.h"

#include "kinalign/protocols/protocols.h"

#include <algorithm>
#include <span>
#include <thread>
#include <utility>

namespace kinalign {

namespace {

constexpr Duration between_looks = std::chrono::milliseconds(100);
constexpr std::size_t most_untaken = 256;  // marks kept for take_marks()

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

/// Returns whether the kernel's stamps give the order of these marks. All marks must have a stamp,
/// and the wall clock must not have been set between them.
bool have_like_stamps(const std::vector<std::pair<RecordedMark, Moment>>& marks) {
  constexpr Duration doubt = std::chrono::milliseconds(50);
  std::optional<Duration> first;
  return std::all_of(marks.begin(), marks.end(), [&](const auto& one) {
    const Moment& came = one.second;
    if (!came.stamp) return false;
    const Duration apart = came.at.time_since_epoch() - came.stamp->time_since_epoch();
    if (!first) first = apart;
    return std::chrono::abs(apart - *first) < doubt;
  });
}

/// A separate key for each port, so that no two ports draw the same nonces.
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

Duration pre_roll_of(const Lab& lab) {
  return Duration{static_cast<std::int64_t>(lab.record.pre_roll_s * 1e9)};
}

}  // namespace

Result<std::unique_ptr<RecordingSession>> RecordingSession::open(Options options, Machine machine) {
  KA_TRY(validate(options.lab));
  std::unique_ptr<RecordingSession> session(new RecordingSession(std::move(options), machine));
  KA_TRY(session->open_ports());
  return session;
}

// The channels of the session come first, so their numbers are the same in every recording.
RecordingSession::RecordingSession(Options options, Machine machine)
    : options_(std::move(options)), machine_(machine), axis_(machine.ports_clock) {
  facts_.host = options_.host;
  facts_.anchor = axis_.watch();
  RecorderOptions recorder;
  recorder.pre_roll = pre_roll_of(options_.lab);
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
  recorder_->when_closed(
      [this](std::uint64_t next, std::uint64_t first) { remember_counts(next, first); });
}

// A device of protocol nodes gets RecordedNodes, any other device a RecordedPort.
Result<void> RecordingSession::open_ports() {
  for (const DeviceOptions& device : options_.lab.devices) {
    const auto protocol = find_protocol(device.protocol);
    if (protocol && row_of(*protocol).answers == Answers::node_requests) {
      nodes_ = KA_TRY(RecordedNodes::open(device, options_.desk, machine_.nodes_clock, *recorder_));
    } else {
      const auto number = static_cast<std::uint8_t>(ports_.size());
      ports_.push_back(
          KA_TRY(RecordedPort::open(device, key_of_port(options_.desk.secret, number))));
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

std::uint64_t RecordingSession::heard() const {
  std::uint64_t heard = nodes_ ? nodes_->receiver().heard() : 0;
  for (const RecordedPort& port : ports_) heard += port.heard();
  return heard;
}

std::uint64_t RecordingSession::held() const {
  std::uint64_t held = nodes_ ? nodes_->held() : 0;
  for (const RecordedPort& port : ports_) held += port.held();
  return held;
}

/// Waking up costs more than processing a message. At a lab's rates the messages of 20 ms are
/// therefore processed together. In a flood the buffers fill, so there is no rest. Resting does not
/// affect clocks: arrivals are stamped by the kernel, and the times of an answer are known. Live
/// clients need each message at once, so there is no rest for them either.
void RecordingSession::rest(Duration patience) {
  constexpr Duration short_rest = std::chrono::milliseconds(20);
  constexpr std::uint64_t few = 32;  // in a turn; the kernel's buffers hold twice as many
  const std::uint64_t all = heard();
  const std::uint64_t came = all - std::exchange(heard_before_, all);
  const HostTime now = axis_.now();
  if (came > few) awake_until_ = now + std::chrono::seconds(1);
  const bool hurries = live_ && live_->has_clients();
  if (came > 0 && now >= awake_until_ && patience >= short_rest && !hurries) {
    std::this_thread::sleep_for(short_rest);
  }
}

/// A device's port is read only when data is waiting; connections are also checked at each look
/// (every 100 ms). All marks are processed first, because data that arrives after a stop does not
/// belong to its take. Data that arrives while ports are read is held back until marks are read
/// again.
bool RecordingSession::turn(Duration patience, std::optional<int> also) {
  if (held() > 0) patience = {};
  rest(patience);
  const bool some = wait(patience, also);
  const HostTime now = axis_.now();
  const bool look_after = now >= next_look_;
  if (look_after) next_look_ = now + between_looks;
  const auto until = mark_ports_.empty() ? std::nullopt : std::optional(Moment{now});
  drain_marks();
  release(until);
  if (look_after && nodes_) nodes_->receiver().tick();
  if (nodes_ && some && waiting_.front().revents != 0) nodes_->drain(until);
  for (std::size_t i = 0; i < ports_.size(); ++i) {
    if (look_after) ports_[i].tick(now);
    if (look_after || (some && is_ready(i))) ports_[i].drain(axis_, *recorder_, until);
  }
  tick(now);
  if (live_) live_->turn();
  takes_.run();
  return some;
}

/// Returns whether data waits at a port. Index into ports_, then mark_ports_.
bool RecordingSession::is_ready(std::size_t port) const {
  const std::size_t begin = port > 0 ? fds_end_[port - 1] : nodes_ ? 1 : 0;
  const auto of_port = std::span(waiting_).subspan(begin, fds_end_[port] - begin);
  return std::any_of(of_port.begin(), of_port.end(),
                     [](const pollfd& one) { return one.revents != 0; });
}

/// Waits for data. Returns whether any has arrived; waiting_ says at which descriptors.
bool RecordingSession::wait(Duration patience, std::optional<int> also) {
  fds_.clear();
  fds_end_.clear();
  if (nodes_) fds_.push_back(nodes_->receiver().fd());
  for (const RecordedPort& port : ports_) {
    port.add_fds(fds_);
    fds_end_.push_back(fds_.size());
  }
  for (const MarkPort& port : mark_ports_) {
    port.add_fds(fds_);
    fds_end_.push_back(fds_.size());
  }
  if (live_) fds_.push_back(live_->fd());
  if (also) fds_.push_back(*also);
  waiting_.clear();
  for (const int fd : fds_) waiting_.push_back({fd, POLLIN, 0});
  const auto ms = std::chrono::ceil<std::chrono::milliseconds>(patience).count();
  return ::poll(waiting_.data(), waiting_.size(), static_cast<int>(ms)) > 0;
}

/// A start mark is recorded in the take that it begins, a stop mark in the take that it ends.
void RecordingSession::mark(const RecordedMark& mark, const Moment& came) {
  using Kind = Mark::Kind;
  const Kind kind = mark.mark.kind;
  if (kind == Kind::start && by_marks_ && by_marks_->starts != Starts::none && !recording()) {
    if (by_marks_->starts == Starts::next) by_marks_->starts = Starts::none;
    start(by_marks_->plan, came.at);
  }
  recorder_->record(mark_channel_, came.at, to_json(mark));
  if (kind == Kind::stop && by_marks_ && recording() && has_room_for_takes()) end_take(came);
  if (marks_.size() < most_untaken) marks_.emplace_back(mark, came.at);
}

void RecordingSession::obey_no_start() {
  if (by_marks_) by_marks_->starts = Starts::none;
}

void RecordingSession::tick(HostTime now) {
  recorder_->tick(now);
  if (now < next_second_) return;
  next_second_ = now + std::chrono::seconds(1);
  tell(now);
  if (nodes_) nodes_->find_strays();
}

/// Records both clocks of the host. During a take it records the counts too.
void RecordingSession::tell(HostTime now) {
  recorder_->record(pairs_, now, to_json(axis_.watch()));
  for (RecordedPort& port : ports_) port.look(now);
  if (nodes_) nodes_->look(now);
  if (!recording()) return;
  for (const RecordedPort& port : ports_) port.tell(*recorder_, counts_, now);
  if (nodes_) nodes_->tell(counts_, now);
  for (const auto& [name, counts] : port_counts()) {
    recorder_->record(port_counts_, now, to_json(CountedPort{name, counts}));
  }
}

void RecordingSession::remember_counts(std::uint64_t chunk, std::uint64_t first) {
  for (RecordedPort& port : ports_) port.remember(chunk, first);
  if (nodes_) nodes_->remember(chunk, first);
  for (const auto& [name, counts] : running_port_counts()) {
    port_counts_past_[name].past.remember(chunk, first, counts);
  }
}

void RecordingSession::begin_counts(std::uint64_t chunk) {
  for (RecordedPort& port : ports_) port.begin(chunk);
  if (nodes_) nodes_->begin(chunk);
  for (auto& [name, port] : port_counts_past_) port.before = port.past.before(chunk);
}

/// `at`: begin of the take; the pre-roll reaches back from there.
void RecordingSession::start(const TakePlan& plan, HostTime at) {
  const auto compression =
      options_.lab.record.compression == "none" ? McapCompression::none : McapCompression::zstd;
  TakeHead head{facts_, expected_of(options_.lab), attachments_of(options_, facts_.anchor.utc)};
  newest_ = begin_take(machine_.files, plan, std::move(head), compression);
  newest_->begun = at;
  takes_.add(newest_);
  begin_counts(recorder_->start(at, [this](McapChunkContent chunk) {
    newest_->disk.push(std::move(chunk), takes_.room(*newest_));
  }));
}

/// Reports a full queue once, until there is space again.
bool RecordingSession::has_room_for_takes() {
  const bool was_full = std::exchange(full_, takes_.is_full());
  if (full_ && !was_full) {
    findings_.push_back(
        {Severity::warning,
         Error{"marks", 0,
               "at most " + std::to_string(TakeQueue::most) + " takes that wait for the disk",
               "a mark that would end one more"},
         "it ends none: what comes stands in the same file, with all marks",
         "see what holds up the disk, or who sends so many marks"});
  }
  return !full_;
}

/// Reads all data of devices that arrived up to `until`, since one turn may not have emptied the
/// kernel's buffers. Stops after 200 ms, so that a flood on a connection cannot delay the end of
/// the take further.
void RecordingSession::drain_devices(const Moment& until) {
  constexpr Duration longest = std::chrono::milliseconds(200);
  const HostTime begun = axis_.now();
  std::uint64_t before = 0;
  release(until);
  do {
    before = heard() - held();
    if (nodes_) nodes_->drain(until);
    for (RecordedPort& port : ports_) port.drain(axis_, *recorder_, until);
  } while (heard() - held() != before && axis_.now() - begun < longest);
}

/// Records held data of devices, up to `until` or all.
void RecordingSession::release(const std::optional<Moment>& until) {
  if (nodes_) nodes_->release(until);
  for (RecordedPort& port : ports_) port.release(axis_, *recorder_, until);
}

/// Processes the marks of all ports in the order of arrival, because a start may come to one port
/// and its stop to another. Data that devices sent between two marks is recorded between them.
void RecordingSession::drain_marks() {
  std::vector<std::pair<RecordedMark, Moment>> all;
  for (MarkPort& port : mark_ports_) {
    port.drain(axis_,
               [&](const RecordedMark& m, const Moment& came) { all.emplace_back(m, came); });
  }
  const bool stamped = have_like_stamps(all);
  std::stable_sort(all.begin(), all.end(), [stamped](const auto& a, const auto& b) {
    return stamped ? a.second.stamp < b.second.stamp : a.second.at < b.second.at;
  });
  for (const auto& [heard, came] : all) {
    release(came);
    mark(heard, came);
  }
}

void RecordingSession::stop() {
  if (!recording()) return;
  const std::shared_ptr<SessionTake> ending = newest_;
  const Moment now{axis_.now()};
  drain_marks();
  if (recording() && newest_ == ending) end_take(now);
}

/// Data that arrived later is held back. It belongs to the next take or to none.
void RecordingSession::end_take(const Moment& came) {
  drain_devices(came);
  const HostTime now = axis_.now();
  tell(now);
  recorder_->stop();
  newest_->end = TakeEnd{now, streams(), port_counts(), {}};
  if (nodes_) newest_->end->nodes = nodes_->receiver().status();
  newest_->disk.finish();
}

std::vector<StreamStatus> RecordingSession::streams() const {
  std::vector<StreamStatus> all;
  for (const RecordedPort& port : ports_) port.add_streams(all);
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

std::vector<std::pair<std::string, PortCounts>> RecordingSession::port_counts() const {
  auto all = running_port_counts();
  for (auto& [name, counts] : all) {
    const auto past = port_counts_past_.find(name);
    if (past != port_counts_past_.end()) counts = since(past->second.before, counts);
  }
  return all;
}

std::vector<std::pair<std::string, PortCounts>> RecordingSession::running_port_counts() const {
  std::vector<std::pair<std::string, PortCounts>> all;
  for (const RecordedPort& port : ports_) all.emplace_back(port.device().name, port.counts());
  if (nodes_) all.emplace_back(nodes_->device().name, nodes_->counts());
  for (const MarkPort& port : mark_ports_) all.emplace_back(port.name(), port.port_counts());
  return all;
}

}  // namespace kinalign
