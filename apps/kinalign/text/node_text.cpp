// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/text/node_text.h"

#include "apps/cli/json_text.h"
#include "apps/kinalign/text/counts_text.h"
#include "apps/kinalign/text/summary.h"
#include "apps/kinalign/text/time_server_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <set>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

/// Texts and JSON state durations in milliseconds.
double ms(Duration d) { return 1e3 * seconds(d); }

/// True if the latest stamp is certified: its interval contains the true time as long as the
/// assumptions about clocks hold.
bool is_certified(const NodeStatus& status) {
  return status.stamp && status.stamp->certainty == Certainty::certified;
}

/// False if the shortest measured round trip is not positive. A clock with a large drift causes
/// that, and the value then means nothing.
bool has_round_trip(const NodeStatus& status) {
  return status.round_trip && *status.round_trip > Duration{0};
}

/// The rate "15.0/s", or a text for a node that is silent or has sent only one frame.
std::string pace_text(const NodeStatus& status, const ClockPair& now) {
  if (status.silent) return "silent since " + utc_text(now.utc - (now.raw - status.last_arrival));
  return status.rate_hz ? fmt::format("{:.1f}/s", *status.rate_hz) : "first frame";
}

/// The reason why a node is not locked, found from its latest stamp: no reply has reached the node,
/// a bound in one direction only, or a contradiction.
std::string_view why_not_locked(const NodeStatus& status) {
  if (!status.stamp) return "no reply of this server has reached it";
  if (status.stamp->certainty == Certainty::one_sided) return "too few exchanges";
  return "its exchanges contradict the assumptions";
}

/// Adds the members about the node's clock: drift, round trip, and the latest stamp with its
/// certified interval. The caller makes sure that the node has sent a counter value.
void add_clock(Json& json, const NodeStatus& status) {
  json["counter_ns"] = status.n->time_since_epoch().count();
  json["drift_ppm"] = 1e6 * status.drift;
  json["drift_deviation_ppm"] = 1e6 * status.drift_deviation;
  if (has_round_trip(status)) json["round_trip_ms"] = ms(*status.round_trip);
  if (!status.stamp) return;
  const ClockStamp& stamp = *status.stamp;
  const bool one_sided = stamp.certainty == Certainty::one_sided;
  json["certainty"] = is_certified(status) ? "certified" : one_sided ? "one_sided" : "doubtful";
  json["time_ns"] = json_ns(stamp.time);
  // A one-sided stamp has only one of the two bounds.
  if (stamp.earliest) json["earliest_ns"] = json_ns(*stamp.earliest);
  if (stamp.latest) json["latest_ns"] = json_ns(*stamp.latest);
  json["assumptions"] = to_string(stamp.assumptions);
}

}  // namespace

std::string address_text(const NodeAddress& address) {
  return endpoint_text(to_string(address.host), address.port);
}

std::string status_text(const NodeStatus& status, const ClockPair& now, std::string_view why) {
  std::string text = fmt::format("node {}  {}", status.node_id, pace_text(status, now));
  // The share of lost frames among all frames, by the numbers that the node gives its frames.
  const std::string lost = share_text(status.lost, status.lost + status.accepted);
  if (!lost.empty()) text += ", " + lost + " lost";
  if (is_certified(status)) {
    // A certified stamp has both bounds of its interval.
    const Duration whole = *status.stamp->latest - *status.stamp->earliest;
    text += fmt::format(", ± {:.2f} ms, drift {:+.1f} ± {:.1f} ppm", ms(whole) / 2,
                        1e6 * status.drift, 1e6 * status.drift_deviation);
    // A node that sends no counter can't be locked, so it gets no reason.
  } else if (status.n) {
    text += fmt::format(", not locked: {}", why.empty() ? why_not_locked(status) : why);
  }
  // For a node without a counter only the mean delay of its frames is known.
  if (status.mean_way) text += fmt::format(", no counter: d {:.1f} ms", ms(*status.mean_way));
  if (has_round_trip(status)) text += fmt::format(", round trip {:.2f} ms", ms(*status.round_trip));
  if (status.battery_mv) text += fmt::format(", {:.2f} V", 1e-3 * *status.battery_mv);
  if (status.old_key) text += ", old key";
  return text;
}

/// The JSON event about one node.
std::string status_json(const NodeStatus& status) {
  Json json{{"event", "node"},
            {"stream", status.stream},
            {"node_id", status.node_id},
            {"boot_id", status.boot_id},
            {"address", address_text(status.address)},
            {"silent", status.silent},
            {"lives", status.sessions},
            {"accepted", status.accepted},
            {"lost", status.lost},
            // After a change of the lab key, this member shows which nodes still use the old key.
            {"old_key", status.old_key}};
  if (status.rate_hz) json["rate_hz"] = *status.rate_hz;
  if (status.battery_mv) json["battery_mv"] = *status.battery_mv;
  if (status.one_way) json["d_ms"] = ms(*status.one_way);
  if (status.mean_way) json["d_mean_ms"] = ms(*status.mean_way);
  if (status.n) add_clock(json, status);
  return json_text(json);
}

std::string nodes_text(const std::vector<NodeStatus>& all) {
  if (all.empty()) return "";
  // A silent node may have been locked when it stopped; it does not count as locked.
  const auto is_locked = [](const auto& s) { return !s.silent && is_certified(s); };
  const auto locked = std::count_if(all.begin(), all.end(), is_locked);
  const auto silent = std::count_if(all.begin(), all.end(), [](const auto& s) { return s.silent; });
  return fmt::format("{}, {} locked{}", counted(all.size(), "node"), locked,
                     silent > 0 ? fmt::format(", {} silent", silent) : "");
}

std::string pair_json(const ClockPair& pair) {
  return json_text(
      Json{{"event", "pair"}, {"raw_ns", json_ns(pair.raw)}, {"utc_ns", to_ns(pair.utc)}});
}

std::string refused_text(const NodeCounts& counts) {
  std::vector<std::pair<std::uint64_t, std::string>> refused;
  // The value 0 means "not refused".
  for (std::size_t i = 1; i < node_refusals; ++i) {
    const auto refusal = static_cast<NodeRefusal>(i);
    refused.emplace_back(counts.refusals[refusal], spaced(refusal_name(refusal)));
  }
  return counts_in_words(refused);
}

/// Groups the refused node ids by the cause of the refusal. An id is only what the frame states,
/// without a proof. The set sorts the ids and names each id once.
std::vector<std::string> claims_text(const RefusedNodes& refused, const NodeCounts& counts,
                                     const NodeNames& names) {
  std::map<NodeRefusal, std::set<std::uint32_t>> claimed;
  for (const auto& claim : refused.claims()) claimed[claim.refusal].insert(claim.node_id);
  std::vector<std::string> lines;
  lines.reserve(claimed.size());
  for (const auto& [refusal, ids] : claimed) {
    std::vector<std::string> who;
    for (const std::uint32_t id : ids) who.push_back(names.short_name(id));
    // The list of refused ids has a limit. Senders beyond it are only counted.
    const char* others = refused.others(refusal) ? " and others" : "";
    lines.push_back(fmt::format("{}: senders that call themselves {} {}{} ({} frames)",
                                spaced(refusal_name(refusal)), names.device, fmt::join(who, ", "),
                                others, grouped(counts.refusals[refusal])));
  }
  return lines;
}

std::string refused_lines(const NodeReceiver& receiver, const NodeNames& names) {
  // If no frame was refused, the text is empty.
  const std::string refused = refused_text(receiver.counts());
  std::string lines = refused.empty() ? "" : "  refused  " + refused + "\n";
  for (const std::string& line : claims_text(receiver.refused_nodes(), receiver.counts(), names)) {
    lines += "  " + line + "\n";
  }
  return lines;
}

/// The JSON about all datagrams: "received" counts each once, and the other members add up to it.
std::string node_counts_json(const NodeReceiver& receiver) {
  const NodeCounts& counts = receiver.counts();
  // Some datagrams are ignored before they are judged; "received" counts them, too.
  Json json{
      {"event", "node_counts"},
      {"received", counts.verdicts.total() + receiver.not_unicast() + receiver.from_port_0()}};
  for (std::size_t i = 0; i < node_verdicts; ++i) {
    const auto verdict = static_cast<NodeVerdict>(i);
    json[kinalign::name_of(verdict)] = counts.verdicts[verdict];
  }
  for (std::size_t i = 1; i < node_refusals; ++i) {
    const auto refusal = static_cast<NodeRefusal>(i);
    json[refusal_name(refusal)] = counts.refusals[refusal];
  }
  for (std::size_t i = 1; i < echo_verdicts; ++i) {
    const auto echo = static_cast<EchoVerdict>(i);
    json[std::string("echo_") + kinalign::name_of(echo)] = counts.echoes[echo];
  }
  json["not_unicast"] = receiver.not_unicast();
  json["from_port_0"] = receiver.from_port_0();
  json["replies"] = counts.answers;
  json["unsent"] = receiver.unsent();
  json["wrong_copies"] = counts.wrong_copies;
  json["with_old_key"] = counts.old_key;
  json["dropped_by_kernel"] = receiver.dropped();
  json["missed_events"] = receiver.missed_events();
  return json_text(json);
}

}  // namespace kinalign
