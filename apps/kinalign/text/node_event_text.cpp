// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/text/node_event_text.h"

#include "apps/cli/json_text.h"
#include "apps/kinalign/text/node_text.h"

#include "kinalign/capture/nodes/node_table.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>

namespace kinalign {

namespace {

using Json = nlohmann::ordered_json;

/// The names of events in JSON, in the order of ClockEvent::Kind and HostClockEvent::Kind.
constexpr std::array clock_event_names{"new_boot", "step",           "slip",      "uneasy",
                                       "settled",  "host_backwards", "withdrawn", "violator",
                                       "relaxed",  "route"};
constexpr std::array host_event_names{"suspended", "backwards", "wall_stepped"};

/// The event in words, without the node's name: the name comes before, so the words begin with a
/// verb. "warning:" marks an event after which the user must act.
std::string what_happened(const NodeEvent& event, const NodeNames& names) {
  using Kind = NodeEvent::Kind;
  switch (event.kind) {
    case Kind::joined:
      return "joined";
    case Kind::started:
      return "restarted";
    case Kind::restarted:
      // The counter of a node begins anew at each start, and a new boot id tells so. With the old
      // boot id, values of two clocks would be mixed.
      return "warning: restarted with its old boot id; its firmware must choose a new boot id at "
             "each start";
    case Kind::twins:
      return "warning: two nodes have this id; they are recorded separately; give one of them "
             "another id";
    case Kind::renamed:
      return fmt::format("seems to be the same device as {}",
                         names.name(event.other_id.value_or(0)));
    case Kind::moved:
      return "sends from another address";
    case Kind::left:
      return "has sent nothing for ten seconds";
    case Kind::returned:
      return "sends again; its clock continues";
    case Kind::newer_version:
      return fmt::format("sends version {} of the protocol, which this program can't read",
                         event.version);
    case Kind::too_many:
      return fmt::format("warning: ignored, because {} nodes are connected already",
                         NodeTable::most_streams);
    // wrong_key_text() gives this text, since it depends on more than the kind.
    case Kind::wrong_key:
      break;
  }
  return {};
}

/// The text about a frame whose MAC (its cryptographic checksum) is missing or wrong. The node id
/// in such a frame proves nothing, because any program may have sent it.
std::string wrong_key_text(const NodeEvent& event, const NodeNames& names) {
  const bool no_key = event.refusal == NodeRefusal::no_key;
  // The user must do something else for each of the three causes.
  const char* what = no_key ? "frames with a MAC, but no --lab-key was given"
                     : event.refusal == NodeRefusal::no_mac ? "frames without a MAC"
                                                            : "frames signed with another key";
  const std::string remedy = no_key ? "; to accept it, give the lab's key with --lab-key FILE"
                                    : fmt::format(
                                          "; if it is that node, flash the key that kinalign "
                                          "node-key --lab-key LAB --node {} prints",
                                          event.node_id);
  return fmt::format("warning: a sender that calls itself {} is refused: it sends {} (from {}){}",
                     names.name(event.node_id), what, address_text(event.address), remedy);
}

}  // namespace

std::string event_text(const NodeEvent& event, const NodeNames& names) {
  if (event.kind == NodeEvent::Kind::newer_version) return "a node " + what_happened(event, names);
  if (event.kind == NodeEvent::Kind::wrong_key) return wrong_key_text(event, names);
  return fmt::format("{}: {} ({})", names.name(event.node_id), what_happened(event, names),
                     address_text(event.address));
}

std::string event_json(const NodeEvent& event) {
  // All kinds of event have these keys. Some kinds add further keys below.
  Json json{
      {"event", "node_event"}, {"kind", name_of(event.kind)}, {"warning", is_warning(event.kind)}};
  const bool is_refused = event.kind == NodeEvent::Kind::wrong_key;  // a refused node has no stream
  if (!is_refused) json["stream"] = event.stream;
  json["node_id"] = event.node_id;
  json["boot_id"] = event.boot_id;
  json["at_ns"] = json_ns(event.at);
  json["address"] = address_text(event.address);
  if (event.other_id) json["other_id"] = *event.other_id;
  if (event.version != 0) json["version"] = event.version;
  if (is_refused) json["refusal"] = refusal_name(event.refusal);
  return json_text(json);
}

/// The event in words. Empty for an event after which the user need not act.
std::string event_text(const ClockEvent& event, std::uint32_t node_id, const NodeNames& names) {
  using Kind = ClockEvent::Kind;
  const double by_ms = 1e3 * std::abs(event.by.value_or(0.0));  // the sign is not always known
  std::string what;
  if (event.kind == Kind::step) {
    // If the size is missing, the step was found by a contradiction and not measured.
    what = event.by ? fmt::format("warning: its counter stepped by at least {:.3f} ms", by_ms)
                    : "warning: its counter stepped, or its drift changes faster than assumed";
  } else if (event.kind == Kind::slip) {
    what = fmt::format("warning: its counter stepped by {:.3f} ms", by_ms);
  } else if (event.kind == Kind::withdrawn) {
    what = fmt::format("warning: the stamps of {:.1f} s are no longer certified",
                       seconds(event.end - event.begin));
  } else if (event.kind == Kind::uneasy) {
    what = fmt::format(
        "its estimated stamps may be wrong by up to {:.3f} ms; their certified intervals stay "
        "correct",
        by_ms);
  } else if (event.kind == Kind::settled) {
    what = "its counter runs evenly again";
  } else if (event.kind == Kind::relaxed) {
    what = "its drift may change faster than assumed";
  }
  // Events without words are of use to programs only.
  return what.empty() ? "" : names.name(node_id) + ": " + what;
}

std::string event_json(const ClockEvent& event, std::size_t stream, std::uint32_t node_id) {
  Json json{{"event", "clock_event"},
            {"kind", clock_event_names.at(static_cast<std::size_t>(event.kind))},
            {"stream", stream},
            {"node_id", node_id},
            {"begin_ns", json_ns(event.begin)},
            {"end_ns", json_ns(event.end)}};
  if (event.by) json["by_ms"] = 1e3 * std::abs(*event.by);
  if (event.curvature) json["curvature_ppm_per_s"] = 1e6 * *event.curvature;
  return json_text(json);
}

/// An event of this machine's clock concerns all nodes at once.
std::string event_text(const HostClockEvent& event) {
  using Kind = HostClockEvent::Kind;
  if (event.kind == Kind::suspended) {
    return fmt::format(
        "warning: this machine slept for {:.1f} s; the nodes' clocks are learnt again",
        seconds(event.by));
  }
  if (event.kind == Kind::backwards) {
    return "warning: this machine's raw clock went back; the nodes' clocks are learnt again";
  }
  return fmt::format("the wall clock was set by {:+.3f} s; stamps of nodes do not depend on it",
                     seconds(event.by));
}

std::string event_json(const HostClockEvent& event) {
  return json_text(Json{{"event", "host_event"},
                        {"kind", host_event_names.at(static_cast<std::size_t>(event.kind))},
                        {"at_ns", json_ns(event.at)},
                        {"by_ms", 1e3 * seconds(event.by)}});
}

}  // namespace kinalign
