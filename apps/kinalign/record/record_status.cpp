// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record/record_status.h"

#include "apps/kinalign/text/summary.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

/// The parts that both kinds of status have: ports, marks, live clients, bytes in memory.
RecordStatus status_of(RecordingSession& session, LabStatus lab) {
  RecordStatus status;
  status.lab = std::move(lab);
  for (const auto& [name, port] : session.ports()) status.lab.port_numbers[name] = port;
  status.waiting_bytes = session.waiting_bytes();
  for (const MarkPort& port : session.mark_ports()) {
    status.mark_ports.emplace_back(port.name(), port.counts());
  }
  if (session.live() != nullptr) status.live = session.live()->counts();
  return status;
}

}  // namespace

RecordStatus status_now(RecordingSession& session, HostTime begun) {
  LabStatus lab{session.now(), begun, session.streams(), {}, session.port_counts()};
  if (session.nodes() != nullptr) lab.nodes = session.nodes()->status();
  RecordStatus status = status_of(session, std::move(lab));
  // The newest take is the one that is recorded now.
  if (!session.takes().empty()) status.disk = session.takes().back()->disk.status();
  status.missing = missing(session.lab(), status.lab);
  return status;
}

RecordStatus status_at_end(RecordingSession& session, HostTime begun) {
  // The oldest take is the one that has ended.
  const SessionTake& take = *session.takes().front();
  TakeEnd end = take.end.value_or(TakeEnd{});
  // Senders of earlier takes have no message in this one.
  std::erase_if(end.streams, [](const StreamStatus& one) { return one.counts.messages == 0; });
  RecordStatus status = status_of(session, {end.at, begun, end.streams, end.nodes, end.ports});
  status.lab.ended = true;
  status.disk = take.disk.status();
  status.missing = missing(session.lab(), status.lab);
  return status;
}

Json json_of(const RecordStatus& status) {
  Json json{{"missing", status.missing}, {"streams", Json::array()}};
  // Without a take there is no disk to report.
  if (status.disk) {
    json["bytes"] = status.disk->bytes;
    json["dropped"] = status.disk->dropped;
  }
  for (const StreamStatus& stream : status.lab.streams) {
    json["streams"].push_back(json_of(stream, status.lab));
  }
  for (const auto& [name, counts] : status.lab.ports) {
    json["ports"][name] = Json::parse(to_json(CountedPort{name, counts}));
  }
  for (const auto& [name, counts] : status.mark_ports) {
    // The ports of marks have the counts of other ports, and some of their own.
    json["ports"][name].update(Json{
        {"marks", counts.marks}, {"repeats", counts.repeats}, {"refused_for", counts.refused}});
  }
  if (status.live) {
    json["live"] = {{"clients", status.live->clients},
                    {"turned_away", status.live->turned_away},
                    {"lost", status.live->lost}};
  }
  return json;
}

std::string end_text(const Lab& lab, const RecordStatus& status) {
  std::string lines;
  for (const std::string& path : status.disk->paths) lines.append(path).append("\n");
  if (const std::uint64_t dropped = status.disk->dropped) {
    lines += fmt::format("  {} messages lost: the disk did not take them\n", grouped(dropped));
  }
  for (const StreamStatus& stream : status.lab.streams) lines += end_line(stream);
  for (const std::string& line : unseen_lines(lab, status.lab)) lines += "  " + line + "\n";
  for (const auto& [name, counts] : status.lab.ports) {
    lines += port_line(name, counts, frames_lost(name, status.lab.streams));
  }
  if (status.live && status.live->lost > 0) {
    lines +=
        fmt::format("  live: slow clients did not get {} messages\n", grouped(status.live->lost));
  }
  return lines;
}

}  // namespace kinalign
