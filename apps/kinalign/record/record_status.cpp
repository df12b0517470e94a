// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/record/record_status.h"

#include "apps/kinalign/text/summary.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

}  // namespace

RecordStatus status_now(RecordingSession& session) {
  RecordStatus status{session.status(), std::nullopt, {}};
  // The newest take is the one that is being recorded.
  if (!session.takes().empty()) status.disk = session.takes().back()->disk.status();
  status.missing = missing(session.lab(), status.lab);
  return status;
}

RecordStatus status_at_end(const RecordingSession& session) {
  // The oldest take is the one that has ended.
  const SessionTake& take = *session.takes().front();
  RecordStatus status{take.end.value_or(LabStatus{}), take.disk.status(), {}};
  status.missing = missing(session.lab(), status.lab);
  return status;
}

Json json_of(const RecordStatus& status, const RecordingSession& session) {
  Json json{{"missing", status.missing}, {"streams", Json::array()}};
  // Without a take no file is written, so there is no status of the disk.
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
  for (const MarkPort& port : session.mark_ports()) {
    // The ports for marks have the counts of other ports and some more.
    const MarkPortCounts& counts = port.counts();
    json["ports"][port.name()].update(Json{
        {"marks", counts.marks}, {"repeats", counts.repeats}, {"refused_for", counts.refused}});
  }
  if (session.live() != nullptr) {
    const LivePortCounts live = session.live()->counts();
    json["live"] = {
        {"clients", live.clients}, {"turned_away", live.turned_away}, {"lost", live.lost}};
  }
  return json;
}

std::string end_text(const RecordStatus& status, const RecordingSession& session) {
  std::string lines;
  for (const std::string& path : status.disk->paths) lines.append(path).append("\n");
  if (const std::uint64_t dropped = status.disk->dropped) {
    lines += fmt::format("  {} messages lost: the disk did not accept them\n", grouped(dropped));
  }
  for (const StreamStatus& stream : status.lab.streams) lines += end_line(stream);
  for (const std::string& line : unseen_lines(session.lab(), status.lab))
    lines += "  " + line + "\n";
  for (const auto& [name, counts] : status.lab.ports) {
    lines += port_line(name, counts, frames_lost(name, status.lab.streams));
  }
  const std::uint64_t lost = session.live() != nullptr ? session.live()->counts().lost : 0;
  if (lost > 0) {
    lines += fmt::format("  live: slow clients did not get {} messages\n", grouped(lost));
  }
  return lines;
}

}  // namespace kinalign
