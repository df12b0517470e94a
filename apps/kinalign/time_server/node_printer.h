// SPDX-License-Identifier: Apache-2.0
// Reports events on the nodes' port while the time server runs, and takes a new lab key if its file
// is replaced.
#pragma once

#include "apps/cli/console.h"
#include "apps/kinalign/text/clock_event_lines.h"

#include "kinalign/capture/nodes/node_receiver.h"

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace kinalign {

/// A lab's key and its file; both are empty if nodes have no keys.
struct LabKeyFile {
  std::string path;
  std::optional<LabKey> key;
};

/// Prints a message of a server that runs for days, on stderr with date and time.
void print_live(Console& console, std::string_view what);

/// Lives as long as the server and is called from its only thread. Faults and events are printed
/// once, so a log of many days stays readable. The printer never waits for the reader of its
/// output.
class NodePrinter {
 public:
  /// `lab`: the key that the receiver has.
  NodePrinter(NodeReceiver& receiver, Console& console, FileSystem& files, LabKeyFile lab)
      : receiver_(receiver), console_(console), files_(files), lab_(std::move(lab)) {}

  /// Called several times a second. Returns a short status: "3 nodes, 2 locked".
  std::string operator()();
  /// The last call: what every node's state was when the server stopped.
  void print_end();

 private:
  using Clock = std::chrono::steady_clock;

  void print_events();
  void print_status();
  // A lab may change its key while nodes are running. The server takes the new key without a
  // restart.
  void look_at_key();
  void print_key_trouble(const std::string& trouble);

  std::string summary_of(const NodeStatus& status) const;

  NodeReceiver& receiver_;
  Console& console_;
  FileSystem& files_;
  LabKeyFile lab_;
  ClockEventLines clock_lines_;
  std::string key_trouble_;  // the fault that was reported and still lasts
  // The schedule advances by whole seconds, so a late call does not shift those after it.
  Clock::time_point next_status_ = Clock::now() + std::chrono::seconds(1);
  int counts_in_s_ = 10;
};

}  // namespace kinalign
