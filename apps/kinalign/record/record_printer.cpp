// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record/record_printer.h"

#include "apps/cli/json_text.h"
#include "apps/kinalign/record/lab_table.h"
#include "apps/kinalign/record/mark_keys.h"
#include "apps/kinalign/text/describe_file.h"
#include "apps/kinalign/text/node_event_text.h"
#include "apps/kinalign/text/node_names.h"
#include "apps/kinalign/text/node_text.h"
#include "apps/kinalign/text/summary.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;
using namespace std::chrono_literals;

std::string ports_text(const RecordingSession& session) {
  std::string text;
  for (const auto& [name, port] : session.ports()) {
    text += fmt::format("{}{} on port {}", text.empty() ? "" : ", ", name, port);
  }
  if (session.live() != nullptr) text += fmt::format("; live on port {}", session.live()->port());
  return text;
}

/// Adds the ports of devices and of live clients to a JSON event.
Json with_ports(Json event, const RecordingSession& session) {
  event["ports"] = Json::object();
  for (const auto& [name, port] : session.ports()) event["ports"][name] = port;
  if (session.live() != nullptr) event["live_port"] = session.live()->port();
  return event;
}

/// The keys with which the user stops waiting for the disk. The first Ctrl-C only ends the
/// recording, unless it ends anyway (`ends`).
std::string_view to_give_up(bool ends) { return ends ? "another Ctrl-C" : "Ctrl-C pressed twice"; }

}  // namespace

RecordPrinter::RecordPrinter(RecordingSession& session, Console& console)
    : session_(session),
      console_(console),
      names_(node_names(session.lab())),
      clock_lines_(names_) {}

// Every complaint is printed at once, for people and for programs.
void RecordPrinter::complain(const std::string& text, const Json& event) {
  console_.complain(harmless("kinalign record: " + text));
  console_.print_json(json_text(event));
  console_.flush();
}

void RecordPrinter::print_waiting() {
  print_ports("waiting for a start", Json{{"event", "waiting"}});
}

/// Prints a line and the ports below it. `event`: the same for programs; the ports are added here.
void RecordPrinter::print_ports(const std::string& line, const Json& event) {
  ports_printed_ = true;
  console_.print(harmless(fmt::format("{}\n  {}\n", line, ports_text(session_))));
  console_.print_json(json_text(with_ports(event, session_)));
  console_.flush();
}

/// Prints the file of the oldest take once. The disk's thread begins the file, so its name is known
/// only some time after the take has started.
void RecordPrinter::print_start() {
  if (session_.takes().empty() || started_.lock() == session_.takes().front()) return;
  const DiskStatus disk = session_.takes().front()->disk.status();
  if (disk.paths.empty()) return;
  started_ = session_.takes().front();
  const std::string& path = disk.paths.front();
  print_ports("recording to " + path, Json{{"event", "started"}, {"file", path}});
}

void RecordPrinter::print(const ReceivedMark& received) {
  const auto& [recorded, at] = received;
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

/// Prints events ten times a second. The status and the table follow once a second.
void RecordPrinter::look(const std::optional<std::string>& typed) {
  print_start();
  // The lines about ports always come first.
  if (!ports_printed_) return;
  for (const ReceivedMark& mark : session_.take_marks()) print(mark);
  const HostTime now = session_.now();
  if (now < next_look_) return;
  next_look_ = now + 100ms;
  print_events();
  const bool second = now >= next_second_;
  // While the user types a text, the table is drawn at once.
  if (!second && !(console_.shows() && typed)) return;
  const RecordStatus status = status_now(session_);
  if (second) {
    next_second_ = now + 1s;
    // Outside a take nothing is written, so the disk needs no forecast.
    if (session_.recording()) look_at_disk(status);
    print_unseen(status.lab);
    print_silent(status.lab);
    if (console_.prints_json()) print_status_json(status);
    console_.flush();
  }
  show(status, typed);
}

/// Prints each event once, as soon as it is known.
void RecordPrinter::print_events() {
  for (const auto& take : session_.takes()) {
    for (const PartFailure& failure : take->disk.take_failures()) print(failure);
  }
  for (const Finding& finding : session_.take_findings()) print(finding);
  for (const HostClockEvent& event : session_.take_clock_events()) print(event);
  if (NodeReceiver* nodes = session_.nodes()) print_node_events(*nodes);
}

/// Prints events of nodes. print_silent() reports nodes that fall silent or return, since it does
/// so for all devices.
void RecordPrinter::print_node_events(NodeReceiver& nodes) {
  using Kind = NodeEvent::Kind;
  for (const NodeEvent& event : nodes.take_node_events()) {
    const bool printed = event.kind == Kind::left || event.kind == Kind::returned;
    if (!printed) console_.note(harmless(event_text(event, names_)));
    console_.print_json(event_json(event));
  }
  const HostTime now = session_.now();
  for (const auto& [stream, node_id, event] : nodes.take_clock_events()) {
    const std::string line = clock_lines_.line(stream, node_id, event, now);
    if (!line.empty()) console_.note(line);
    console_.print_json(event_json(event, stream, node_id));
  }
}

/// Prints the number of lost messages at the first loss, and again each time the number has
/// doubled.
void RecordPrinter::print_dropped(std::uint64_t dropped) {
  // Without this rule a long fault would print thousands of lines.
  if (dropped == 0 || dropped < 2 * dropped_) return;
  dropped_ = dropped;
  complain(fmt::format("{} messages lost: memory is full, and the disk does not accept data",
                       grouped(dropped)),
           Json{{"event", "dropped"}, {"dropped", dropped}});
  console_.ring();
}

/// Updates the forecast of the disk. Warns before the disk is full, and ends the take when it is
/// full. Bytes that still wait in memory count as written.
void RecordPrinter::look_at_disk(const RecordStatus& status) {
  // Each take has a new forecast and new counts.
  if (forecast_of_.lock() != session_.takes().back()) {
    forecast_of_ = session_.takes().back();
    forecast_ = {};
    dropped_ = 0;
  }
  const DiskStatus& disk = *status.disk;
  print_dropped(disk.dropped);
  if (!disk.free_bytes) return;
  // Bytes that wait in memory will soon be on the disk, so they are subtracted from the free space.
  const std::uint64_t to_write = std::min(session_.waiting_bytes(), *disk.free_bytes);
  forecast_.look(status.lab.now, disk.bytes + disk.waiting_bytes, *disk.free_bytes - to_write);
  // The disk stays full until the take has ended; exchange() makes sure that the message is printed
  // once.
  if (forecast_.full() && !std::exchange(disk_full_, true)) {
    complain(fmt::format("the disk has {} MiB left; the take ends now and is complete",
                         *forecast_.free() >> 20U),
             Json{{"event", "disk_full"}, {"free_bytes", *forecast_.free()}});
  } else if (forecast_.take_warning()) {
    const double minutes = *forecast_.minutes_left();
    complain(fmt::format("warning: the disk is full in {:.0f} min at this rate", minutes),
             Json{{"event", "disk_low"}, {"minutes_left", minutes}});
    console_.ring();
  }
}

/// Prints the devices that have sent nothing, once, 5 s after the start.
void RecordPrinter::print_unseen(const LabStatus& status) {
  if (status.now - status.begun < 5s || std::exchange(unseen_printed_, true)) return;
  for (const std::string& line : unseen_lines(session_.lab(), status)) {
    console_.note(harmless(line));
  }
}

/// Prints each sender that falls silent, with a bell, and each sender that returns.
void RecordPrinter::print_silent(const LabStatus& status) {
  for (const auto& [stream, silent] : silent_senders_.changes(status)) {
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

void RecordPrinter::print(const Finding& finding) {
  std::string lines = finding_lines({finding}, console_);
  // complain() adds a line end, so the one from finding_lines() is removed.
  lines.pop_back();
  console_.complain(lines);
  // A warning makes the exit code of the take 1.
  warned_ = warned_ || finding.severity != Severity::note;
  console_.print_json(json_text(Json{{"event", "finding"},
                                     {"severity", std::string(to_string(finding.severity))},
                                     {"what", to_string(finding.what)},
                                     {"meaning", finding.meaning},
                                     {"repair", finding.repair}}));
}

void RecordPrinter::print(const HostClockEvent& event) {
  console_.complain("kinalign record: " + event_text(event));
  console_.print_json(event_json(event));
}

void RecordPrinter::print(const PartFailure& failure) {
  const std::string why = to_string(failure.why);
  complain(
      // If no further file can be begun, the data stays in memory.
      why + ": " +
          (failure.next.empty() ? "kept in memory and tried again"
                                : "continues in " + failure.next),
      Json{{"event", "disk_failed"}, {"what", why}, {"goes_on_in", failure.next}});
}

void RecordPrinter::print_slow_begin() {
  complain(
      "the take's file does not exist yet, because the disk does not respond; data waits in memory",
      Json{{"event", "begin_waits"}});
}

void RecordPrinter::print_refused_end(const Error& why, bool ends) {
  complain(fmt::format("{}: the end of the take is kept in memory and tried again for 30 s: make "
                       "room, or discard it with {}",
                       to_string(why), to_give_up(ends)),
           Json{{"event", "end_refused"}, {"what", to_string(why)}});
}

void RecordPrinter::print_slow_end(std::uint64_t waiting_bytes, bool ends) {
  complain(fmt::format("{:.1f} MB wait for the disk; {} discards what the disk has not accepted",
                       megabytes(waiting_bytes), to_give_up(ends)),
           Json{{"event", "end_waits"}, {"waiting_bytes", waiting_bytes}});
}

/// Prints the event "status" for programs.
void RecordPrinter::print_status_json(const RecordStatus& status) {
  Json event{{"event", "status"}};
  event.update(json_of(status, session_));
  if (status.disk) event["waiting_bytes"] = session_.waiting_bytes();
  if (const auto free = forecast_.free()) event["free_bytes"] = *free;
  if (const auto left = forecast_.minutes_left()) event["minutes_left"] = *left;
  console_.print_json(json_text(event));
}

/// The line about the disk. Without a take: the line that says what recording waits for.
std::string RecordPrinter::disk_line() const {
  if (session_.takes().empty()) return "waiting for a start";
  const DiskStatus oldest = session_.takes().front()->disk.status();
  if (session_.takes().front()->end && !oldest.finished && !oldest.paths.empty()) {
    // The oldest take has ended, but its data is still being written to the disk.
    return "disk  writing the end of " + oldest.paths.back();
  }
  const DiskStatus disk = session_.takes().back()->disk.status();
  if (disk.paths.empty()) return "disk  creating the take's file";
  return disk_text(forecast_, disk.bytes, disk.paths.back());
}

/// Draws the table and below it two lines: about the disk and about the keys.
void RecordPrinter::show(const RecordStatus& status, const std::optional<std::string>& typed) {
  if (!console_.shows()) return;
  constexpr std::size_t below = 2;  // the lines about the disk and the keys
  std::vector<std::pair<std::string, Colour>> lines;
  // On a terminal of one line the difference would be negative without std::min.
  const std::size_t rows = console_.rows() - std::min(below, console_.rows());
  for (const TableLine& line :
       fitted(lab_table(session_.lab(), status.lab, console_.columns()), rows)) {
    lines.emplace_back(harmless(line.text), line.bad ? Colour::bad : Colour::plain);
  }
  // The line turns red at ten minutes, together with the first warning.
  const auto left = forecast_.minutes_left();
  lines.emplace_back(harmless(disk_line()), left && *left < 10 ? Colour::bad : Colour::plain);
  lines.emplace_back(typed ? "text: " + harmless(*typed) : mark_keys_text, Colour::plain);
  console_.show(lines);
}

/// Prints the result of a take, or that the take ended without a file.
RecordStatus RecordPrinter::print_end() {
  print_start();
  // Events that have come until now belong to this take.
  print_events();
  RecordStatus status = status_at_end(session_);
  const DiskStatus& disk = *status.disk;
  if (disk.paths.empty()) {
    if (disk.dropped > 0) {
      console_.complain(
          fmt::format("kinalign record: {} messages lost: the take's file could not be created",
                      grouped(disk.dropped)));
    }
    console_.print_json(json_text(Json{{"event", "never_begun"}, {"dropped", disk.dropped}}));
    return status;
  }
  std::string lines = end_text(status, session_);
  if (const NodeReceiver* nodes = session_.nodes()) lines += refused_lines(*nodes, names_);
  Json event{{"event", "stopped"}, {"files", disk.paths}};
  event.update(json_of(status, session_));
  console_.print(harmless(lines));
  console_.print_json(json_text(event));
  return status;
}

}  // namespace kinalign
