// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/text/clock_event_lines.h"

#include "apps/kinalign/text/node_event_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace kinalign {

namespace {

using EventKind = ClockEvent::Kind;

/// Three steps within this time mean that a clock contradicts the assumptions
/// (docs/clock_assumptions.md).
constexpr Duration steps_within = std::chrono::seconds(10);
/// A clock that contradicted the assumptions is trusted again after this time without an event.
constexpr Duration quiet = std::chrono::minutes(1);

bool is_step(EventKind kind) { return kind == EventKind::step || kind == EventKind::slip; }

/// True for an event that contradicts the assumptions about clocks, and for an event that follows
/// from a contradiction.
bool is_trouble(EventKind kind) {
  return is_step(kind) || kind == EventKind::withdrawn || kind == EventKind::violator ||
         kind == EventKind::settled || kind == EventKind::relaxed || kind == EventKind::uneasy;
}

}  // namespace

// If another node now has the stream, the record of its clock starts anew. A contradiction may
// withdraw the same stretch of time several times; only the first withdrawal gets a line.
std::string ClockEventLines::line(std::size_t stream, std::uint32_t node_id,
                                  const ClockEvent& event, HostTime now) {
  // The first event of a stream makes the entry.
  Clock& clock = clocks_[stream];
  if (clock.node_id != node_id) clock = {};
  clock.node_id = node_id;
  if (!is_trouble(event.kind)) return "";
  // The state is judged before this event is noted: a minute without trouble ends a contradiction.
  clock.contradicts = contradicts(stream, node_id, now);
  clock.troubled = now;
  // While a clock contradicts the assumptions, further events only update the time of the latest
  // trouble.
  if (clock.contradicts) return "";
  if (is_step(event.kind)) {
    // The new step replaces the oldest of the three stored steps.
    std::rotate(clock.steps.begin(), clock.steps.begin() + 1, clock.steps.end());
    clock.steps.back() = event.end;
    const HostTime first = clock.steps.front();
    // With fewer than three steps so far, the first element is still HostTime::min().
    clock.contradicts = first != HostTime::min() && event.end - first <= steps_within;
    if (clock.contradicts) {
      return fmt::format(
          "{}: warning: {}, so none of its stamps are certified; its steps are reported again "
          "after "
          "a minute without steps",
          names_.name(node_id), contradiction_text);
    }
  }
  if (event.kind == EventKind::withdrawn) {
    const HostTime printed = clock.withdrawn;
    clock.withdrawn = std::max(printed, event.end);
    // The withdrawal of this stretch was printed already.
    if (event.begin < printed) return "";
  }
  return event_text(event, node_id, names_);
}

bool ClockEventLines::contradicts(std::size_t stream, std::uint32_t node_id, HostTime now) const {
  const auto found = clocks_.find(stream);
  if (found == clocks_.end() || found->second.node_id != node_id) return false;
  return found->second.contradicts && now - found->second.troubled < quiet;
}

}  // namespace kinalign
