// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record/record_herald.h"

#include "apps/cli/json_text.h"
#include "apps/kinalign/record/lab_table.h"
#include "apps/kinalign/record/mark_keys.h"
#include "apps/kinalign/text/describe_file.h"
#include "apps/kinalign/text/node_event_text.h"
#include "apps/kinalign/text/node_names.h"
#include "apps/kinalign/text/node_text.h"
#include "apps/kinalign/text/summary.h"

#include "kinalign/capture/recorder/recording_session.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;
using namespace std::chrono_literals;

Json ports_of(const RecordingSession& session) {
  Json ports = Json::object();
  for (const auto& [name, port] : session.ports()) ports[name] = port;
  return ports;
}

std::string ports_text(const RecordingSession& session) {
  std::string text;
  for (const auto& [name, port] : session.ports()) {
    text += fmt::format("{}{} on port {}", text.empty() ? "" : ", ", name, port);
  }
  if (session.live() != nullptr) text += fmt::format("; live on port {}", session.live()->port());
  return text;
}

/// Adds the ports of devices and of live clients to an event.
Json with_ports(Json event, const RecordingSession& session) {
  event["ports"] = ports_of(session);
  if (session.live() != nullptr) event["live_port"] = session.live()->port();
  return event;
}

void add_live(const RecordingSession& session, Json& event) {
  if (session.live() == nullptr) return;
  const LivePortCounts& counts = session.live()->counts();
  event["live"] = {
      {"clients", counts.clients}, {"turned_away", counts.turned_away}, {"lost", counts.lost}};
}

/// The line about messages that slow clients did not get. Empty if no client lost any.
std::string live_line(const RecordingSession& session) {
  if (session.live() == nullptr || session.live()->counts().lost == 0) return "";
  return fmt::format("  live: slow clients did not get {} messages\n",
                     grouped(session.live()->counts().lost));
}

/// The keys that give up waiting. `ends`: recording ends anyway; else the first Ctrl-C only ends
/// it.
std::string_view to_give_up(bool ends) { return ends ? "another Ctrl-C" : "Ctrl-C pressed twice"; }

}  // namespace

RecordHerald::RecordHerald(RecordingSession& session, Console& console)
    : session_(session),
      console_(console),
      names_(node_names(session.lab())),
      clock_news_(names_),
      begun_(session.now()) {}

std::vector<std::string> RecordHerald::unheard_required() const {
  Lab lab = session_.lab();
  std::erase_if(lab.devices, [](const DeviceOptions& device) { return !device.required; });
  return unheard_in_take(lab, status_at_end());
}

LabStatus RecordHerald::lab_status() const {
  LabStatus status{session_.now(), begun_, session_.streams(), {}, session_.port_counts()};
  if (session_.nodes() != nullptr) status.nodes = session_.nodes()->status();
  return status;
}

/// The status at the end of the take. Data that came while the rest was written belongs to the next
/// take.
LabStatus RecordHerald::status_at_end() const {
  const TakeEnd& end = *take_->end;
  return {end.at, begun_, end.streams, end.nodes, end.ports};
}

void RecordHerald::follow(std::shared_ptr<SessionTake> take) { take_ = std::move(take); }

void RecordHerald::tell_waiting() {
  ports_told_ = true;
  console_.print(harmless(fmt::format("waiting for a start\n  {}\n", ports_text(session_))));
  console_.print_json(json_text(with_ports(Json{{"event", "waiting"}}, session_)));
  console_.flush();
}

void RecordHerald::tell_start(const std::string& path) {
  ports_told_ = true;
  console_.print(harmless(fmt::format("recording to {}\n  {}\n", path, ports_text(session_))));
  console_.print_json(json_text(with_ports(Json{{"event", "started"}, {"file", path}}, session_)));
  console_.flush();
}

void RecordHerald::tell(const HeardMark& heard) {
  const auto& [recorded, at] = heard;
  const Mark& mark = recorded.mark;
  console_.note(
      harmless(fmt::format("mark: {}{}{}, by {}", kinalign::name_of(mark.kind),
                           mark.text.empty() ? "" : " ", shown(mark.text), recorded.source)));
  Json event{{"event", "mark"}};
  event.update(Json::parse(to_json(recorded)));
  event["raw_ns"] = at.time_since_epoch().count();
  console_.print_json(json_text(event));
  console_.flush();
}

/// Prints marks at once, news ten times a second, and the status and the table once a second.
void RecordHerald::look(const std::optional<std::string>& typed) {
  if (!ports_told_) return;
  for (const HeardMark& heard : session_.take_marks()) tell(heard);
  const HostTime now = session_.now();
  if (now < next_look_) return;
  next_look_ = now + 100ms;
  tell_news();
  const bool second = now >= next_second_;
  if (!second && !(console_.shows() && typed)) return;
  const LabStatus status = lab_status();
  if (second) {
    next_second_ = now + 1s;
    if (session_.recording()) look_at_disk(now);
    tell_who_lacks(status);
    tell_who_is_silent(status);
    if (console_.prints_json()) tell_status(status);
    console_.flush();
  }
  show(status, typed);
}

/// Reports each event once, as soon as it is known.
void RecordHerald::tell_news() {
  for (SessionTake* take : {take_.get(), session_.newest_take().get()}) {
    if (take == nullptr) continue;
    for (const PartFailure& failure : take->disk.take_failures()) tell(failure);
  }
  for (const Finding& finding : session_.take_findings()) tell(finding);
  for (const HostClockEvent& event : session_.take_clock_events()) tell(event);
  if (NodeReceiver* nodes = session_.nodes()) tell_news_of(*nodes);
}

/// Silent and returned nodes are left out here: tell_who_is_silent() reports them for all devices
/// alike.
void RecordHerald::tell_news_of(NodeReceiver& nodes) {
  using Kind = NodeEvent::Kind;
  for (const NodeEvent& event : nodes.take_node_events()) {
    const bool told = event.kind == Kind::left || event.kind == Kind::returned;
    if (!told) console_.note(harmless(event_text(event, names_)));
    console_.print_json(event_json(event));
  }
  const HostTime now = session_.now();
  for (const auto& [stream, node_id, event] : nodes.take_clock_events()) {
    clock_news_.add(stream, node_id, event, now);
    console_.print_json(event_json(event, stream, node_id));
  }
  for (const std::string& line : clock_news_.lines(now)) console_.note(line);
}

/// Reports lost messages at once, and then each time the number has doubled.
void RecordHerald::tell_dropped(std::uint64_t dropped) {
  if (dropped == 0 || dropped < 2 * dropped_told_) return;
  dropped_told_ = dropped;
  console_.complain(fmt::format(
      "kinalign record: {} messages lost: memory is full, and the disk does not take them",
      grouped(dropped)));
  console_.print_json(json_text(Json{{"event", "dropped"}, {"dropped", dropped}}));
  console_.ring();
}

/// Updates the forecast of the disk, ends the take if the disk is full, and warns before. Bytes
/// that still wait in memory count as written.
void RecordHerald::look_at_disk(HostTime now) {
  const auto& newest = session_.newest_take();
  if (watched_.lock() != newest) {
    watched_ = newest;
    forecast_ = {};
    dropped_told_ = 0;
  }
  const DiskStatus disk = newest->disk.status();
  tell_dropped(disk.dropped);
  if (!disk.free_bytes) return;
  const std::uint64_t to_write = std::min(session_.waiting_bytes(), *disk.free_bytes);
  forecast_.look(now, disk.bytes + disk.waiting_bytes, *disk.free_bytes - to_write);
  if (forecast_.full() && !std::exchange(disk_full_, true)) {
    console_.complain(
        fmt::format("kinalign record: the disk has {} MiB left; the take ends here, in order",
                    *forecast_.free() >> 20U));
    console_.print_json(json_text(Json{{"event", "disk_full"}, {"free_bytes", *forecast_.free()}}));
  } else if (forecast_.take_warning()) {
    const double minutes = *forecast_.minutes_left();
    console_.complain(fmt::format(
        "kinalign record: warning: the disk is full in {:.0f} min at this rate", minutes));
    console_.print_json(json_text(Json{{"event", "disk_low"}, {"minutes_left", minutes}}));
    console_.ring();
  }
}

/// Reports devices that have sent nothing, once, 5 s after the start.
void RecordHerald::tell_who_lacks(const LabStatus& status) {
  if (status.now - status.begun < 5s || std::exchange(lacks_told_, true)) return;
  const auto ports = session_.ports();
  for (const std::string& line :
       lines_of_unheard(session_.lab(), status, {ports.begin(), ports.end()})) {
    console_.note(harmless(line));
  }
}

/// Reports each sender that falls silent, with a bell, or comes back.
void RecordHerald::tell_who_is_silent(const LabStatus& status) {
  for (const auto& [stream, silent] : silence_news_.changes(status)) {
    if (silent) console_.ring();
    console_.note(harmless(fmt::format("{} from {} {}", kinalign::name_of(stream), stream.sender,
                                       silent ? "fell silent" : "is back")));
    Json event{{"event", silent ? "silent" : "returned"},
               {"stream", stream.stream},
               {"sender", stream.sender}};
    if (!stream.node.empty()) event["node"] = stream.node;
    console_.print_json(json_text(event));
  }
}

void RecordHerald::tell(const Finding& finding) {
  std::string lines = finding_lines({finding}, console_);
  lines.pop_back();  // complain() adds the line end
  console_.complain(lines);
  warned_ = warned_ || finding.severity != Severity::note;
  console_.print_json(json_text(Json{{"event", "finding"},
                                     {"severity", std::string(to_string(finding.severity))},
                                     {"what", to_string(finding.what)},
                                     {"meaning", finding.meaning},
                                     {"repair", finding.repair}}));
}

void RecordHerald::tell(const HostClockEvent& event) {
  console_.complain("kinalign record: " + event_text(event));
  console_.print_json(event_json(event));
}

void RecordHerald::tell(const PartFailure& failure) {
  console_.complain(harmless(fmt::format(
      "kinalign record: {}: {}", to_string(failure.why),
      failure.next.empty() ? "kept in memory and tried again" : "goes on in " + failure.next)));
  console_.print_json(json_text(Json{
      {"event", "disk_failed"}, {"what", to_string(failure.why)}, {"goes_on_in", failure.next}}));
}

void RecordHerald::tell_refused(const Error& why, bool ends) {
  console_.complain(harmless(
      fmt::format("kinalign record: {}: the end of the take is kept in memory and tried again for "
                  "30 s: make room, or give it up with {}",
                  to_string(why), to_give_up(ends))));
  console_.print_json(json_text(Json{{"event", "end_refused"}, {"what", to_string(why)}}));
  console_.flush();
}

void RecordHerald::tell_slow(std::uint64_t waiting_bytes, bool ends) {
  console_.complain(
      fmt::format("kinalign record: {:.1f} MB wait for the disk; {} loses what it has not taken",
                  megabytes(waiting_bytes), to_give_up(ends)));
  console_.print_json(json_text(Json{{"event", "end_waits"}, {"waiting_bytes", waiting_bytes}}));
  console_.flush();
}

void RecordHerald::tell_slow_begin() {
  console_.complain(
      "kinalign record: the disk has not begun the take's file yet; what comes waits in memory");
  console_.print_json(json_text(Json{{"event", "begin_waits"}}));
  console_.flush();
}

void RecordHerald::tell_never_begun(const DiskStatus& disk) {
  if (disk.dropped > 0) {
    console_.complain(fmt::format("kinalign record: {} messages lost: the take never had a file",
                                  grouped(disk.dropped)));
  }
  console_.print_json(json_text(Json{{"event", "never_begun"}, {"dropped", disk.dropped}}));
}

/// The event "status" for programs.
void RecordHerald::tell_status(const LabStatus& status) {
  Json event{{"event", "status"}};
  if (const auto& take = session_.newest_take()) {
    const DiskStatus disk = take->disk.status();
    event["bytes"] = disk.bytes;
    event["waiting_bytes"] = session_.waiting_bytes();
    event["dropped"] = disk.dropped;
    if (const auto free = forecast_.free()) event["free_bytes"] = *free;
    if (const auto left = forecast_.minutes_left()) event["minutes_left"] = *left;
  }
  event["missing"] = missing(session_.lab(), status);
  event["streams"] = Json::array();
  for (const StreamStatus& stream : status.streams) {
    event["streams"].push_back(json_of(stream, status));
  }
  for (const auto& [name, counts] : status.ports) {
    event["ports"][name] = Json::parse(to_json(CountedPort{name, counts}));
  }
  add_live(session_, event);
  console_.print_json(json_text(event));
}

/// The line about the disk, or what recording waits for.
std::string RecordHerald::disk_line() const {
  if (take_ && take_->end) {
    const DiskStatus ended = take_->disk.status();
    if (!ended.finished && !ended.paths.empty()) {
      return "disk  writes the end of " + ended.paths.back();
    }
  }
  if (!session_.recording()) return "waiting for a start";
  const DiskStatus disk = session_.newest_take()->disk.status();
  if (disk.paths.empty()) return "disk  begins the take's file";
  return disk_text(forecast_, disk.bytes, disk.paths.back());
}

/// Draws the table with the disk's line and the line of keys below it.
void RecordHerald::show(const LabStatus& status, const std::optional<std::string>& typed) {
  if (!console_.shows()) return;
  constexpr std::size_t below = 2;  // the disk's line and the line of keys
  std::vector<std::pair<std::string, Colour>> lines;
  const std::size_t rows = console_.rows() - std::min(below, console_.rows());
  for (const TableLine& line :
       fitted(lab_table(session_.lab(), status, console_.columns()), rows)) {
    lines.emplace_back(harmless(line.text), line.bad ? Colour::bad : Colour::plain);
  }
  const auto left = forecast_.minutes_left();
  lines.emplace_back(harmless(disk_line()), left && *left < 10 ? Colour::bad : Colour::plain);
  lines.emplace_back(typed ? "text: " + harmless(*typed) : mark_keys_text, Colour::plain);
  console_.show(lines);
}

/// Prints the end of a take: files, losses, senders, ports and refused nodes.
void RecordHerald::tell_end() {
  tell_news();
  const LabStatus status = status_at_end();
  const DiskStatus disk = take_->disk.status();
  Json event{{"event", "stopped"},
             {"files", disk.paths},
             {"bytes", disk.bytes},
             {"dropped", disk.dropped},
             {"streams", Json::array()}};
  std::string lines;
  for (const std::string& path : disk.paths) lines.append(path).append("\n");
  if (disk.dropped > 0) {
    lines += fmt::format("  {} messages lost: the disk did not take them\n", grouped(disk.dropped));
  }
  for (const StreamStatus& stream : status.streams) {
    event["streams"].push_back(json_of(stream, status));
    lines += end_line(stream);
  }
  const auto ports = session_.ports();
  for (const std::string& line :
       end_lines_of_unheard(session_.lab(), status, {ports.begin(), ports.end()})) {
    lines += "  " + line + "\n";
  }
  event["missing"] = unheard_required();
  for (const auto& [name, counts] : status.ports) {
    event["ports"][name] = Json::parse(to_json(CountedPort{name, counts}));
    lines += port_line(name, counts, frames_lost(name, status.streams));
  }
  for (const MarkPort& port : session_.mark_ports()) {
    event["ports"][port.name()].update(Json{{"marks", port.counts().marks},
                                            {"repeats", port.counts().repeats},
                                            {"refused_for", port.counts().refused}});
  }
  if (const NodeReceiver* nodes = session_.nodes()) lines += refused_lines(*nodes, names_);
  lines += live_line(session_);
  add_live(session_, event);
  console_.print(harmless(lines));
  console_.print_json(json_text(event));
}

}  // namespace kinalign
