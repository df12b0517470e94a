// SPDX-License-Identifier: Apache-2.0
#include "apps/kinalign/time_server/node_printer.h"

#include "apps/kinalign/text/node_event_text.h"
#include "apps/kinalign/text/node_text.h"
#include "apps/kinalign/text/time_server_text.h"

namespace kinalign {

void print_live(Console& console, std::string_view what) {
  console.note(live_line(SystemClocks{}.utc(), what));
}

/// Prints events at each call, so that they appear soon. Once a second it also prints the status
/// lines and reads the key file, which may have been replaced.
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

/// Prints the events of this machine's clock, of nodes and of their clocks.
void NodePrinter::print_events() {
  for (const HostClockEvent& event : receiver_.take_host_events()) {
    print_live(console_, event_text(event));
    console_.print_json(event_json(event));
  }
  for (const NodeEvent& event : receiver_.take_node_events()) {
    print_live(console_, event_text(event));
    console_.print_json(event_json(event));
  }
  // All events get the same time `now`. It tells how long ago a clock last caused trouble.
  const HostTime now = SystemClocks{}.raw();
  for (const auto& [stream, node_id, event] : receiver_.take_clock_events()) {
    const std::string line = clock_lines_.line(stream, node_id, event, now);
    // Events that change nothing for a user give no line; --json prints every event.
    if (!line.empty()) print_live(console_, line);
    console_.print_json(event_json(event, stream, node_id));
  }
}

/// Prints the status for --json only. From the clock pairs and states a program can follow every
/// node's clock.
void NodePrinter::print_status() {
  for (const ClockPair& pair : receiver_.take_pairs()) console_.print_json(pair_json(pair));
  for (const NodeStatus& status : receiver_.status()) console_.print_json(status_json(status));
  // The counts change slowly, so they are printed every ten seconds.
  if (--counts_in_s_ > 0) return;
  counts_in_s_ = 10;
  console_.print_json(node_counts_json(receiver_));
}

/// Reads the key file. The keys stay as they are if the file is missing, incomplete or can't be
/// read.
void NodePrinter::look_at_key() {
  if (lab_.path.empty()) return;
  const auto key = read_lab_key(files_, lab_.path);
  print_key_trouble(key ? "" : to_string(key.error()));
  // The key is replaced only if the file has another key than before.
  if (!key || *key == lab_.key) return;
  lab_.key = *key;
  receiver_.replace_key(*key);
  print_live(console_, lab_.path + " has a new key; the old key stays valid for 60 s");
  console_.print_json(R"({"event": "key_replaced"})");
}

/// Prints a fault of the key file once for as long as it lasts.
void NodePrinter::print_key_trouble(const std::string& trouble) {
  // If the text is the same, the fault still lasts. If the text is empty, the fault is over.
  if (trouble == key_trouble_) return;
  key_trouble_ = trouble;
  if (trouble.empty()) return;
  print_live(console_, "warning: " + trouble + "; the key that was read before stays in use");
  console_.print_json(R"({"event": "key_unreadable"})");
}

/// The line about one node. It states ages by the raw clock and dates by UTC, so `now` has both.
std::string NodePrinter::summary_of(const NodeStatus& status) const {
  SystemClocks clocks;
  const ClockPair now{.raw = clocks.raw(), .utc = clocks.utc()};
  const bool bad = clock_lines_.contradicts(status.stream, status.node_id, now.raw);
  return status_text(status, now, bad ? contradiction_text : "");
}

/// Prints the last events, the state of each node, and the nodes that were refused.
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
