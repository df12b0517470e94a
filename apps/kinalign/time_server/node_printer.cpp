// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/time_server/node_printer.h"

#include "apps/kinalign/text/node_event_text.h"
#include "apps/kinalign/text/node_text.h"
#include "apps/kinalign/text/time_server_text.h"

namespace kinalign {

void print_live(Console& console, std::string_view what) {
  console.note(live_line(SystemClocks{}.utc(), what));
}

/// Events are printed at each call, so that they appear soon. Status lines and the key file are due
/// once a second.
std::string NodePrinter::operator()() {
  print_events();
  if (Clock::now() >= next_status_) {
    next_status_ += std::chrono::seconds(1);
    print_status();
    look_at_key();
  }
  console_.flush();
  return nodes_text(receiver_.status());
}

/// Reports events of this machine, of nodes and of their clocks.
void NodePrinter::print_events() {
  for (const HostClockEvent& event : receiver_.take_host_events()) {
    print_live(console_, event_text(event));
    console_.print_json(event_json(event));
  }
  for (const NodeEvent& event : receiver_.take_node_events()) {
    print_live(console_, event_text(event));
    console_.print_json(event_json(event));
  }
  // One instant for all events: repeated trouble of a clock is judged by the time since the last
  // one.
  const HostTime now = SystemClocks{}.raw();
  for (const auto& [stream, node_id, event] : receiver_.take_clock_events()) {
    const std::string line = clock_lines_.line(stream, node_id, event, now);
    // Some events change nothing for a user and give no line; programs get every event.
    if (!line.empty()) print_live(console_, line);
    console_.print_json(event_json(event, stream, node_id));
  }
}

/// JSON only. Clock pairs and states allow a program to follow every node's clock.
void NodePrinter::print_status() {
  for (const ClockPair& pair : receiver_.take_pairs()) console_.print_json(pair_json(pair));
  for (const NodeStatus& status : receiver_.status()) console_.print_json(status_json(status));
  // The counts change slowly, so they are written every tenth second.
  if (--counts_in_s_ > 0) return;
  counts_in_s_ = 10;
  console_.print_json(node_counts_json(receiver_));
}

/// Reads the key file once a second. A file that can't be read, is half written or is missing
/// leaves the keys as they are.
void NodePrinter::look_at_key() {
  if (lab_.path.empty()) return;
  const auto key = read_lab_key(files_, lab_.path);
  print_key_trouble(key ? "" : to_string(key.error()));
  // The file is read every second, but only another content is a new key.
  if (!key || *key == lab_.key) return;
  lab_.key = *key;
  receiver_.replace_key(*key);
  print_live(console_, lab_.path + " has a new key; the old key stays valid for 60 s");
  console_.print_json(R"({"event": "key_replaced"})");
}

/// Reports a fault of the key file once, as long as it lasts.
void NodePrinter::print_key_trouble(const std::string& trouble) {
  // The same text means that the fault lasts. An empty text means that it is over.
  if (trouble == key_trouble_) return;
  key_trouble_ = trouble;
  if (trouble.empty()) return;
  print_live(console_, "warning: " + trouble + "; the key that was read before stays in use");
  console_.print_json(R"({"event": "key_unreadable"})");
}

/// `now` has both clocks: the status gives ages by the raw clock and dates by UTC.
std::string NodePrinter::summary_of(const NodeStatus& status) const {
  SystemClocks clocks;
  const ClockPair now{.raw = clocks.raw(), .utc = clocks.utc()};
  const bool bad = clock_lines_.contradicts(status.stream, status.node_id, now.raw);
  return status_text(status, now, bad ? contradiction_text : "");
}

/// Reports the last events, each node's status, and refused nodes.
void NodePrinter::print_end() {
  print_events();
  for (const NodeStatus& status : receiver_.status()) {
    console_.print("  " + summary_of(status) + "\n");
    console_.print_json(status_json(status));
  }
  console_.print(refused_lines(receiver_));
  console_.print_json(node_counts_json(receiver_));
}

}  // namespace kinalign
