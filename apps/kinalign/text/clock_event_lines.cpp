// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/text/clock_event_lines.h"

#include "apps/kinalign/text/node_event_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace kinalign {

namespace {

using EventKind = ClockEvent::Kind;

/// Three steps within this time mean a clock that contradicts the assumptions.
constexpr Duration steps_within = std::chrono::seconds(10);
/// Such a clock is trusted again after this time without an event.
constexpr Duration quiet = std::chrono::minutes(1);
/// A withdrawal without a cause is printed after this time.
constexpr Duration patience = std::chrono::seconds(1);

bool is_step(EventKind kind) { return kind == EventKind::step || kind == EventKind::slip; }

/// True for events that contradict the assumptions about clocks, and for those that follow from
/// one.
bool is_trouble(EventKind kind) {
  return is_step(kind) || kind == EventKind::withdrawn || kind == EventKind::violator ||
         kind == EventKind::settled || kind == EventKind::relaxed || kind == EventKind::uneasy;
}

}  // namespace

/// The stream's clock. A stream may have passed to another node; then the clock starts anew.
ClockEventLines::Clock& ClockEventLines::clock_of(std::size_t stream, std::uint32_t node_id) {
  Clock& clock = clocks_[stream];
  if (clock.node_id != node_id) {
    print_waiting(clock);
    clock = {};
    clock.node_id = node_id;
  }
  return clock;
}

void ClockEventLines::add(std::size_t stream, std::uint32_t node_id, const ClockEvent& event,
                          HostTime now) {
  Clock& clock = clock_of(stream, node_id);
  if (!is_trouble(event.kind)) return;
  if (!contradicts(stream, node_id, now)) clock.contradicts = false;
  clock.troubled = now;
  if (is_step(event.kind)) return take_step(clock, event);
  if (clock.contradicts) return;
  if (event.kind == EventKind::withdrawn) return withdraw(clock, event, now);
  clock.settled = event.kind == EventKind::settled;
  const std::string text = event_text(event, node_id, names_);
  if (!text.empty()) lines_.push_back(text);
}

/// Keeps the last three steps. From the third step within `steps_within` on, one line replaces the
/// lines for single steps.
void ClockEventLines::take_step(Clock& clock, const ClockEvent& event) {
  std::rotate(clock.steps.begin(), clock.steps.begin() + 1, clock.steps.end());
  clock.steps.back() = event.end;
  clock.settled = false;
  if (clock.contradicts) return;
  const HostTime first = clock.steps.front();
  clock.contradicts = first != HostTime::min() && event.end - first <= steps_within;
  if (!clock.contradicts) return lines_.push_back(event_text(event, clock.node_id, names_));
  clock.waiting.reset();
  lines_.push_back(
      fmt::format("{}: warning: {}, so none of its stamps are certified; its steps are reported "
                  "again after a minute without steps",
                  names_.name(clock.node_id), contradiction));
}

/// Collects withdrawn stretches; overlapping ones become one. A stretch withdrawn right after the
/// clock settled is not printed if it was printed before.
void ClockEventLines::withdraw(Clock& clock, const ClockEvent& event, HostTime now) {
  const bool known =
      clock.printed && event.begin >= clock.printed->begin && event.begin <= clock.printed->end;
  if (std::exchange(clock.settled, false) && known) return;
  if (!clock.waiting) {
    clock.waiting = Stretch{event.begin, event.end, now};
    return;
  }
  clock.waiting->begin = std::min(clock.waiting->begin, event.begin);
  clock.waiting->end = std::max(clock.waiting->end, event.end);
}

/// Prints the collected withdrawal as one line, and remembers it.
void ClockEventLines::print_waiting(Clock& clock) {
  if (!clock.waiting) return;
  const ClockEvent whole{EventKind::withdrawn, 0, clock.waiting->begin, clock.waiting->end};
  lines_.push_back(event_text(whole, clock.node_id, names_));
  clock.printed = std::exchange(clock.waiting, std::nullopt);
}

std::vector<std::string> ClockEventLines::lines(HostTime now) {
  for (auto& [stream, clock] : clocks_) {
    if (!clock.waiting) continue;
    const bool caused = clock.steps.back() >= clock.waiting->end;
    if (caused || now - clock.waiting->since >= patience) print_waiting(clock);
  }
  return std::exchange(lines_, {});
}

bool ClockEventLines::contradicts(std::size_t stream, std::uint32_t node_id, HostTime now) const {
  const auto found = clocks_.find(stream);
  if (found == clocks_.end() || found->second.node_id != node_id) return false;
  return found->second.contradicts && now - found->second.troubled < quiet;
}

}  // namespace kinalign
